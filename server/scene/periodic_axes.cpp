#include "scene/periodic_axes.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "scene/shapes.h"

namespace spherule::scene {

namespace {

constexpr const char* axisNames[] = {"X", "Y", "Z"};
constexpr double parallel = 1e-9;  // component of a unit normal

// Returns the first periodic axis along which the obstacle is not the same everywhere; nullopt if there is none.
std::optional<std::size_t> axisAcross(const Obstacle& obstacle, const Bounds& bounds) {
    const std::optional<glm::dvec3> normal = obstacle.shape->normalOfHalfSpace();
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (bounds.periodic[axis] && (!normal || std::abs((*normal)[static_cast<int>(axis)]) > parallel)) return axis;
    return std::nullopt;
}

bool isAcross(const glm::dvec3& axis, const Bounds& bounds) {
    for (int k = 0; k < 3; ++k)
        if (bounds.periodic[static_cast<std::size_t>(k)] && std::abs(axis[k]) < 1 - parallel) return true;
    return false;
}

// Refuses a field that is not the same along all periodic axes.
Result<void> checkField(const Field& field, const Bounds& bounds, const std::string& name) {
    constexpr const char* oneCentre = "has one centre, but a periodic axis would repeat it; remove one of them";
    if (std::holds_alternative<Attraction>(field)) return fail(ErrorKind::Input, at(name, "attraction"), oneCentre);
    if (std::holds_alternative<Spring>(field)) return fail(ErrorKind::Input, at(name, "spring"), oneCentre);
    if (const auto* const drag = std::get_if<Drag>(&field))
        if (drag->vortex && isAcross(drag->vortex->axis, bounds))
            return fail(
                ErrorKind::Input, at(name, "drag.vortex"),
                "has one axis, but a periodic axis would repeat it; turn the vortex along the periodic axis, or "
                "remove one of them");
    const auto& region = regionOf(field);
    if (!region) return {};
    const auto* const box = std::get_if<Box>(&*region);
    for (int axis = 0; axis < 3; ++axis)
        if (bounds.periodic[static_cast<std::size_t>(axis)] &&
            (box == nullptr || box->min[axis] > bounds.min[axis] || box->max[axis] < bounds.max[axis]))
            return fail(ErrorKind::Input, name,
                        fmt::format("has a region that ends along the periodic axis {}; with periodic axes, the region "
                                    "must be a box that spans the bounds along them",
                                    axisNames[axis]));
    return {};
}

}  // namespace

void readPeriodicAxes(Check& check, const v1::Bounds& message, std::string_view field, Bounds& bounds) {
    const auto count = static_cast<std::size_t>(message.periodic_size());
    check.entries(at(field, "periodic"), count, [&](std::size_t k, const std::string& at) {
        const int axis = message.periodic(static_cast<int>(k)) - v1::X;
        if (axis < 0 || axis > 2) return check.refuse(at, fmt::format("is {}, must be X, Y or Z", axis + v1::X));
        const auto index = static_cast<std::size_t>(axis);
        for (const std::size_t face : {2 * index, 2 * index + 1})
            if (bounds.open[face])
                check.refuse(at, fmt::format("is {0}, but the face {0}_{1} is open; an axis is periodic, or its faces "
                                             "are walls or open",
                                             axisNames[index], face % 2 == 0 ? "MIN" : "MAX"));
        bounds.periodic[index] = true;
    });
}

bool spansPeriod(const Bounds& bounds, const Box& region, int axis) {
    return bounds.periodic[static_cast<std::size_t>(axis)] && region.min[axis] == bounds.min[axis] &&
           region.max[axis] == bounds.max[axis];
}

glm::dvec3 insideBounds(const Bounds& bounds, glm::dvec3 place) {
    const glm::dvec3 periods = bounds.periods();
    for (int axis = 0; axis < 3; ++axis)
        if (periods[axis] > 0)
            place[axis] -= periods[axis] * std::floor((place[axis] - bounds.min[axis]) / periods[axis]);
    return place;
}

Result<void> checkPeriodicAxes(const Scene& scene) {
    if (!scene.bounds.anyPeriodic()) return {};
    for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
        if (const auto axis = axisAcross(scene.obstacles[k], scene.bounds))
            return fail(ErrorKind::Input, at("obstacles", k),
                        fmt::format("is not the same along the whole periodic axis {}; with periodic axes, obstacles "
                                    "must be planes that are parallel to them",
                                    axisNames[*axis]));
    for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
        if (scene.obstacles[k].motion && scene.obstacles[k].motion->speeds().turn > 0)
            return fail(ErrorKind::Input, at(at("obstacles", k), "motion"),
                        "turns a plane; with periodic axes, planes must stay parallel to them");
    for (std::size_t k = 0; k < scene.forces.fields.size(); ++k)
        if (auto fits = checkField(scene.forces.fields[k], scene.bounds, at("fields", k)); !fits) return fits;
    return {};
}

}  // namespace spherule::scene
