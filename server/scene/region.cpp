#include "scene/region.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/obstacle.pb.h"

namespace spherule::scene {

namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};

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
