#include "scene/region.h"

#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "spherule/v1/obstacle.pb.h"

namespace spherule::scene {

namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // clang 14 needs it

}  // namespace

bool contains(const Region& region, const glm::dvec3& place) {
    return std::visit(
        Overloaded{[&](const Box& box) { return box.contains(place); },
                   [&](const BallRegion& ball) { return glm::distance(ball.centre, place) <= ball.radius; },
                   [&](const CylinderRegion& cylinder) {
                       const glm::dvec3 middle = 0.5 * (cylinder.from + cylinder.to);
                       const glm::dvec3 axis = glm::normalize(cylinder.to - cylinder.from);
                       const double along = glm::dot(place - middle, axis);
                       return std::abs(along) <= 0.5 * glm::distance(cylinder.from, cylinder.to) &&
                              glm::length(place - middle - along * axis) <= cylinder.radius;
                   }},
        region);
}

BallRegion ballAround(const Region& region) {
    return std::visit(
        Overloaded{[](const Box& box) {
                       return BallRegion{0.5 * (box.min + box.max), 0.5 * glm::distance(box.min, box.max)};
                   },
                   [](const BallRegion& ball) { return ball; },
                   [](const CylinderRegion& cylinder) {
                       return BallRegion{0.5 * (cylinder.from + cylinder.to),
                                         std::hypot(0.5 * glm::distance(cylinder.from, cylinder.to), cylinder.radius)};
                   }},
        region);
}

double volumeOf(const Region& region) {
    constexpr double pi = std::numbers::pi;
    return std::visit(
        Overloaded{[](const Box& box) {
                       const glm::dvec3 side = box.max - box.min;
                       return side.x * side.y * side.z;
                   },
                   [](const BallRegion& ball) { return 4 * pi / 3 * ball.radius * ball.radius * ball.radius; },
                   [](const CylinderRegion& cylinder) {
                       return pi * cylinder.radius * cylinder.radius * glm::distance(cylinder.from, cylinder.to);
                   }},
        region);
}

Box boxAround(const Region& region) {
    return std::visit(
        Overloaded{
            [](const Box& box) { return box; },
            [](const BallRegion& ball) {
                return Box{ball.centre - ball.radius, ball.centre + ball.radius};
            },
            [](const CylinderRegion& cylinder) {
                const glm::dvec3 axis = glm::normalize(cylinder.to - cylinder.from);
                const glm::dvec3 ends =
                    cylinder.radius * glm::sqrt(glm::max(glm::dvec3(1) - axis * axis, glm::dvec3(0)));
                return Box{glm::min(cylinder.from, cylinder.to) - ends, glm::max(cylinder.from, cylinder.to) + ends};
            }},
        region);
}

glm::dvec3 placeIn(const Box& box, Random& random) {
    glm::dvec3 p{};
    for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(box.min[axis], box.max[axis]);
    return p;
}

glm::dvec3 placeIn(const BallRegion& ball, Random& random) {
    for (;;) {
        glm::dvec3 p{};
        for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-1, 1);
        if (glm::dot(p, p) <= 1) return ball.centre + ball.radius * p;
    }
}

glm::dvec3 placeInRing(const glm::dvec3& normal, double hole, double radius, Random& random) {
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

glm::dvec3 placeIn(const CylinderRegion& cylinder, Random& random) {
    const glm::dvec3 along = cylinder.to - cylinder.from;
    const glm::dvec3 foot = cylinder.from + along * random.uniform();
    return foot + placeInRing(glm::normalize(along), 0, cylinder.radius, random);
}

void refuseForm(Check& check, bool given, const std::string& field) {
    if (given) check.refuse(field, "is true; a region is the inside of a solid shape: leave it out");
}

BallRegion readBall(Check& check, const v1::SphereShape& message, const std::string& field) {
    refuseForm(check, message.hollow(), at(field, "hollow"));
    return {check.vector(message.centre(), at(field, "centre")),
            check.upTo(message.radius(), largestComponent, at(field, "radius"), " m")};
}

CylinderRegion readCylinder(Check& check, const v1::CylinderShape& message, const std::string& field) {
    refuseForm(check, message.hollow(), at(field, "hollow"));
    refuseForm(check, message.open(), at(field, "open"));
    const Ends ends = readEnds(check, message.from(), message.to(), field);
    return {ends.from, ends.to, check.upTo(message.radius(), largestComponent, at(field, "radius"), " m")};
}

}  // namespace spherule::scene
