#pragma once

#include <string>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "scene/random.h"

// Figures that tests record as properties.
namespace spherule::physics {

inline std::string figure(double value) {
    return fmt::format("{:.4g}", value);
}

// The largest of several figures, and the case that it belongs to.
struct Worst {
    double value = 0;
    std::string of = "no case";

    void see(double figure, const std::string& name) {
        if (!(figure > value)) return;
        value = figure;
        of = name;
    }
};

// Returns a vector of three normal numbers.
inline glm::dvec3 normalVector(scene::Random& random) {
    const double x = random.normal();
    const double y = random.normal();
    return {x, y, random.normal()};
}

}  // namespace spherule::physics
