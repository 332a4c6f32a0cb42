#include "scene/fields.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace spherule::scene {

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

glm::dvec3 Drag::velocityAt(const glm::dvec3& place) const {
    if (!vortex) return velocity;
    const glm::dvec3 around = glm::cross(vortex->axis, place - vortex->centre);
    const double distance = glm::length(around);
    const double core = vortex->core;
    return velocity + around * (distance < core ? vortex->speed / core : vortex->speed * core / (distance * distance));
}

const std::optional<Region>& regionOf(const Field& field) {
    return std::visit([](const auto& one) -> const std::optional<Region>& { return one.region; }, field);
}

bool addsEnergy(const Field& field) {
    const auto* const drag = std::get_if<Drag>(&field);
    return drag != nullptr ? drag->moves() : regionOf(field).has_value();
}

double submergedVolume(double radius, double depth) {
    const double h = std::clamp(depth + radius, 0.0, 2 * radius);
    return pi * h * h * (3 * radius - h) / 3;
}

double submergedIntegral(double radius, double depth) {
    const double h = std::clamp(depth + radius, 0.0, 2 * radius);
    const double cap = pi * h * h * h * (4 * radius - h) / 12;
    return cap + 4 * pi / 3 * radius * radius * radius * std::max(depth - radius, 0.0);
}

}  // namespace spherule::scene
