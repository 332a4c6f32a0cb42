#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"
#include "sim/population.h"

namespace spherule::sim {

class Simulation;

// A body that a sphere touches.
struct TouchedBody {
    std::variant<std::uint64_t, std::string> body;  // the id of a sphere, or a surface as in SurfaceForce
    double overlap = 0;  // fraction of the smaller radius; below 0: a gap within the tolerance
};

// The state of one sphere, in SI units.
struct Inspection {
    std::uint64_t sphere = 0;  // id
    double time = 0;           // s simulated
    glm::dvec3 position{};
    glm::dvec3 velocity{};
    glm::dvec3 spin{};
    std::optional<double> mass{};  // nullopt: the sphere is fixed
    double radius = 0;
    std::string material{};
    std::uint32_t touches = 0;            // number of bodies that it touches
    std::vector<TouchedBody> contacts{};  // at most `mostContacts` of them, the deepest first
    static constexpr std::size_t mostContacts = 64;
};

// Returns the rank of a sphere. NoSuchSphere if there is none with this id; the error names `field`.
Result<std::uint32_t> rankOf(const Population& population, std::uint64_t id, std::string_view field);

// Returns the present state of a sphere, or the same error. Compares its place with all others on the device, and
// copies a few rows. Waits for the device.
Result<Inspection> inspect(Simulation& simulation, std::uint64_t id, std::string_view field);

}  // namespace spherule::sim
