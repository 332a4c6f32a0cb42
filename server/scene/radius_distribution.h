#pragma once

#include <optional>
#include <string_view>

#include "scene/random.h"

namespace spherule::v1 {
class Radius;
}

namespace spherule::scene {

class Check;

constexpr double smallestRadius = 1e-6;  // m
constexpr double largestRadius = 1e6;    // m

// A validated distribution of radii: always the same, uniform in min..max, or normal cut to min..max.
struct RadiusDistribution {
    struct Bell {
        double mean = 0;
        double deviation = 0;
    };

    double min = 0;  // m
    double max = 0;  // m
    std::optional<Bell> bell;

    // A constant distribution draws no random number.
    [[nodiscard]] float draw(Random& random) const;
};

// Reads a single radius (m).
double readRadius(Check& check, double value, std::string_view field);

RadiusDistribution readRadiusDistribution(Check& check, const v1::Radius& message, std::string_view field);

}  // namespace spherule::scene
