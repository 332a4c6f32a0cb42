#include "scene/emitter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace spherule::scene {

namespace {

// Random numbers for the properties of the spheres, and for their places.
enum class Purpose : std::uint8_t { Properties, Places };

Random randomFor(const Emitter& emitter, Purpose purpose, std::uint64_t number) {
    constexpr std::uint64_t apart = 0x9e3779b97f4a7c15U;  // odd, so that no two streams have the same seed
    const std::uint64_t stream = 2 * emitter.stream + static_cast<std::uint64_t>(purpose) + 1;
    return Random(emitter.seed + apart * stream, number);
}

glm::dvec3 placeIn(const DiscRegion& disc, Random& random) {
    return disc.centre + placeInRing(disc.normal, disc.hole, disc.radius, random);
}

// Returns the seconds of work in a part of a cycle.
double workedIn(const std::vector<Span>& schedule, double end) {
    double sum = 0;
    for (const Span& span : schedule) sum += std::clamp(end - span.from, 0.0, span.to - span.from);
    return sum;
}

}  // namespace

double Emitter::workedUntil(double time) const {
    const double since = time - begin;
    if (!(since > 0)) return 0;
    if (schedule.empty()) return since;
    const double cycles = repeat > 0 ? std::floor(since / repeat) : 0;
    const double perCycle = workedIn(schedule, std::numeric_limits<double>::infinity());
    return cycles * perCycle + workedIn(schedule, since - cycles * repeat);
}

double Emitter::timeAfter(double worked) const {
    if (schedule.empty()) return begin + worked;
    const double perCycle = workedIn(schedule, std::numeric_limits<double>::infinity());
    const double cycles = repeat > 0 ? std::floor(worked / perCycle) : 0;
    double left = worked - cycles * perCycle;
    for (const Span& span : schedule) {
        if (left <= span.to - span.from) return begin + cycles * repeat + span.from + left;
        left -= span.to - span.from;
    }
    return std::numeric_limits<double>::infinity();
}

Sphere Emitter::sphere(std::uint64_t number) const {
    Random random = randomFor(*this, Purpose::Properties, number);
    Sphere made{.radius = radii.draw(random), .material = material, .group = group, .spin = spin};
    glm::dvec3 start = velocity;
    if (velocitySpread > 0) start += placeIn(BallRegion{.radius = velocitySpread}, random);
    made.velocity = glm::vec3(start);
    return made;
}

glm::dvec3 Emitter::place(std::uint64_t number, unsigned attempt) const {
    Random random = randomFor(*this, Purpose::Places, number * mostAttempts + attempt);
    return std::visit([&](const auto& one) { return placeIn(one, random); }, region);
}

double Emitter::massOf(const Sphere& sphere) const {
    const auto r = static_cast<double>(sphere.radius);
    return 4.0 / 3 * std::numbers::pi * r * r * r * density;
}

double Emitter::meanMass() const {
    return 4.0 / 3 * std::numbers::pi * radii.meanCube() * density;
}

}  // namespace spherule::scene
