#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/radius_distribution.h"
#include "scene/region.h"
#include "scene/sphere.h"

namespace spherule::v1 {
class Emitter;
}

namespace spherule::scene {

// The surface between two circles.
struct DiscRegion {
    glm::dvec3 centre{};  // m
    glm::dvec3 normal{};  // of unit length
    double radius = 0;    // m
    double hole = 0;      // m: inner radius, below `radius`
};

// Where an emitter makes spheres: their centres are in this region, or on this surface. A box may be flat along one
// axis.
using EmissionRegion = std::variant<Box, BallRegion, CylinderRegion, DiscRegion>;

// A time during which an emitter works (s after its beginning).
struct Span {
    double from = 0;
    double to = 0;
};

// Makes spheres while the simulation runs. The numbers of its spheres count from 0. Everything about a sphere follows
// from its number and the seed.
struct Emitter {
    std::string name{};
    EmissionRegion region{};
    double rate = 0;      // spheres per second of work; 0: massFlow
    double massFlow = 0;  // kg per second of work
    RadiusDistribution radii{};
    std::uint8_t material = 0;             // index into Scene::materials
    double density = 1000;                 // of the material, kg/m^3
    glm::dvec3 velocity{};                 // m/s
    double velocitySpread = 0;             // m/s: velocities are uniform in a ball of this radius about `velocity`
    glm::vec3 spin{};                      // rad/s
    std::optional<std::uint64_t> total{};  // spheres; nullopt: no end
    std::optional<double> untilChoked{};   // s of work without a free place, after which it ends; nullopt: never
    double origin = 0;                     // s simulated: the message's `begin` counts from here
    double begin = 0;                      // s simulated
    std::vector<Span> schedule{};          // ascending; empty: always
    double repeat = 0;                     // s: the schedule begins again; 0: never
    std::uint64_t seed = 1;
    std::uint64_t stream = 0;  // of random numbers; separates emitters with the same seed
    std::uint16_t group = 0;   // of its spheres: index into Scene::groups
    // Some of its spheres, among them a smallest and a largest one. Substeps, features and cells must suit them.
    std::vector<Sphere> samples{};
    double expected = 0;                           // spheres present at the same time, to choose the number of cells
    std::shared_ptr<const v1::Emitter> message{};  // as in the scene

    // Returns the seconds of work from the beginning until `time` (s simulated).
    [[nodiscard]] double workedUntil(double time) const;
    // Returns the time (s simulated) at which it has worked for `worked` seconds; infinity if it never does.
    [[nodiscard]] double timeAfter(double worked) const;

    // Returns a sphere by its number, without a position.
    [[nodiscard]] Sphere sphere(std::uint64_t number) const;
    // Returns the place (m) of a sphere in its `attempt`-th attempt, below mostAttempts. Uniform in the region.
    [[nodiscard]] glm::dvec3 place(std::uint64_t number, unsigned attempt) const;
    [[nodiscard]] double meanMass() const;  // of its spheres (kg)
    [[nodiscard]] double massOf(const Sphere& sphere) const;

    static constexpr unsigned mostAttempts = 8;
};

struct EmitterProgress {
    std::uint64_t born = 0;  // spheres
    bool ended = false;      // it makes no more
};

}  // namespace spherule::scene
