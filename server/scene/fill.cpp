#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scene/occupancy.h"
#include "scene/periodic_axes.h"
#include "scene/source.h"
#include "scene/surroundings.h"

namespace spherule::scene {

namespace {

// Places are drawn until one is free. Equal spheres placed this way jam at 0.38 of the volume. The budget is far above
// the work for 0.3, and ends an impossible request.
constexpr std::uint64_t workPerSphere = 2'000;
constexpr std::uint64_t workAtLeast = 10'000'000;
constexpr std::uint64_t workAtMost = 4'000'000'000;  // tens of seconds, for all groups of a scene
constexpr double jammed = 0.38;
constexpr std::size_t betweenMarks = 1024;  // spheres

// Returns the spheres by falling radius, because large ones find no place later. Equal radii keep their order.
std::vector<std::uint32_t> byFallingRadius(const std::vector<Sphere>& spheres) {
    std::vector<std::uint32_t> order(spheres.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto smaller = [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; };
    const auto [least, most] = std::ranges::minmax_element(spheres, smaller);
    if (least->radius == most->radius) return order;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return spheres[a].radius > spheres[b].radius; });
    return order;
}

glm::dvec3 drawPlace(Random& random, const Box& region, const Bounds& bounds, double radius) {
    glm::dvec3 place{};
    for (int axis = 0; axis < 3; ++axis) {
        const double inset = spansPeriod(bounds, region, axis) ? 0 : radius;
        place[axis] = random.uniform(region.min[axis] + inset, region.max[axis] - inset);
    }
    return place;
}

bool placeAll(Check& check, std::vector<Sphere>& spheres, const Box& region, const Scene& scene, Occupancy& occupancy,
              Random& random, std::size_t& placed) {
    const std::uint64_t budget =
        std::min(occupancy.work() + std::max(workPerSphere * spheres.size(), workAtLeast), workAtMost);
    for (const std::uint32_t i : byFallingRadius(spheres)) {
        const auto radius = static_cast<double>(spheres[i].radius);
        do {
            occupancy.addWork(1 + scene.obstacles.size());
            if (occupancy.work() > budget || !check.goesOn("placing spheres", placed, spheres.size())) return false;
            spheres[i].position = drawPlace(random, region, scene.bounds, radius);
        } while (obstacleAt(scene, spheres[i].position, radius) || !occupancy.isFree(spheres[i].position, radius));
        occupancy.add(spheres[i].position, radius);
        ++placed;
    }
    return true;
}

}  // namespace

std::vector<Sphere> fromFill(Check& check, const v1::Fill& fill, const Scene& scene, Occupancy& taken,
                             SourceInput input) {
    const RadiusDistribution& radii = requiredRadii(check, input);
    const Box region = check.box(fill.min(), fill.max(), input.field);
    const std::string countField = at(input.field, "count");
    if (fill.count() == 0) check.refuse(countField, "is 0 or missing, must be at least 1");
    if (!check.ok()) return {};
    const auto room = checkRoom(check, input, fill.count(), countField,
                                Occupancy::mostBytesPerSphere() + 2 * sizeof(std::uint32_t));  // places and their order
    if (!room) return {};
    const glm::dvec3 side = region.max - region.min;
    if (const double narrowest = std::min({side.x, side.y, side.z}); narrowest < 2 * radii.max) {
        check.refuse(
            input.field,
            fmt::format("is {} m wide between min and max, too narrow for a radius of {} m", narrowest, radii.max),
            Cause::TooLarge, {.least = {}, .most = narrowest / 2});
        return {};
    }

    const double smallest = 4.0 / 3 * std::numbers::pi * std::pow(radii.min, 3);
    const double least = fill.count() * smallest;
    if (least > jammed * side.x * side.y * side.z) {
        check.refuse(countField,
                     fmt::format("asks for {} spheres, at least {:.3g} of the volume between min and max; "
                                 "random places without overlaps end at {}",
                                 fill.count(), least / (side.x * side.y * side.z), jammed),
                     Cause::NoRoom, {.least = {}, .most = std::floor(jammed * side.x * side.y * side.z / smallest)});
        return {};
    }

    std::vector<Sphere> spheres;
    spheres.reserve(fill.count());
    while (spheres.size() < fill.count()) {
        if (spheres.size() % betweenMarks == 0 && !check.goesOn("drawing radii", spheres.size(), fill.count()))
            return {};
        spheres.push_back({.velocity = input.velocity, .radius = radii.draw(input.random), .spin = input.spin});
    }
    std::size_t placed = 0;
    if (!placeAll(check, spheres, region, scene, taken, input.random, placed)) {
        check.refuse(countField,
                     fmt::format("asks for {} spheres, but no free place was found after {}; lower the count "
                                 "or make the region larger",
                                 fill.count(), placed),
                     Cause::NoRoom, {.least = {}, .most = static_cast<double>(placed)});
        return {};
    }
    return spheres;
}

}  // namespace spherule::scene
