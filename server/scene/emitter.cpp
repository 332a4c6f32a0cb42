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

// Returns a point that is uniform in a ball of this radius about 0, by rejection: exactly rounded arithmetic alone.
glm::dvec3 inBall(Random& random, double radius) {
    for (;;) {
        glm::dvec3 p{};
        for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-1, 1);
        if (glm::dot(p, p) <= 1) return radius * p;
    }
}

// Returns a point of the surface between two circles about 0, uniform, in the plane across `normal`.
glm::dvec3 inRing(Random& random, const glm::dvec3& normal, double hole, double radius) {
    const glm::dvec3 other = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(normal, other));
    const glm::dvec3 v = glm::cross(normal, u);
    const double distance = std::sqrt(random.uniform(hole * hole, radius * radius));
    for (;;) {
        const double x = random.uniform(-1, 1);
        const double y = random.uniform(-1, 1);
        const double square = x * x + y * y;
        if (square > 1 || square < 1e-6) continue;
        return (u * x + v * y) * (distance / std::sqrt(square));
    }
}

glm::dvec3 placeIn(const Box& box, Random& random) {
    glm::dvec3 p{};
    for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(box.min[axis], box.max[axis]);
    return p;
}

glm::dvec3 placeIn(const BallRegion& ball, Random& random) {
    return ball.centre + inBall(random, ball.radius);
}

glm::dvec3 placeIn(const CylinderRegion& cylinder, Random& random) {
    const glm::dvec3 along = cylinder.to - cylinder.from;
    const glm::dvec3 foot = cylinder.from + along * random.uniform();
    return foot + inRing(random, glm::normalize(along), 0, cylinder.radius);
}

glm::dvec3 placeIn(const DiscRegion& disc, Random& random) {
    return disc.centre + inRing(random, disc.normal, disc.hole, disc.radius);
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
    if (velocitySpread > 0) start += inBall(random, velocitySpread);
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
    double sum = 0;
    for (const Sphere& sphere : samples) sum += massOf(sphere);
    return sum / static_cast<double>(samples.size());
}

}  // namespace spherule::scene
