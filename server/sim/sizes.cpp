#include "sim/sizes.h"

#include <algorithm>
#include <cmath>

#include "sim/layout.h"

namespace spherule::sim {

namespace {

constexpr double classWidth = 2;

std::vector<SizeClass> classesOf(const scene::Scene& scene, const Radii& radii) {
    const double octaves = std::log(radii.largest / radii.smallest) / std::log(classWidth);
    const int count = std::clamp(static_cast<int>(std::ceil(octaves)), 1, static_cast<int>(MOST_LEVELS));
    // From the largest down: the coarsest cells are then as full as they can be.
    const double wide = std::max(octaves / count, 1.0);
    std::vector<SizeClass> classes(static_cast<std::size_t>(count));
    for (const scene::Sphere& sphere : scene.spheres) {
        const auto r = static_cast<double>(sphere.radius);
        const double below = std::log(radii.largest / r) / std::log(classWidth) / wide;
        const int place = count - 1 - std::clamp(static_cast<int>(below), 0, count - 1);
        SizeClass& mine = classes[static_cast<std::size_t>(place)];
        mine.smallest = mine.spheres == 0 ? r : std::min(mine.smallest, r);
        mine.largest = std::max(mine.largest, r);
        ++mine.spheres;
    }
    std::erase_if(classes, [](const SizeClass& one) { return one.spheres == 0; });
    return classes;
}

}  // namespace

Radii radiiOf(const scene::Scene& scene) {
    if (scene.spheres.empty()) return {0.05, 0.05, 0.05, 0.05, {{0.05, 0.05, 0}}};
    Radii radii{1e30, 0, 0, 0, {}};
    double cubes = 0;
    const auto count = static_cast<double>(scene.spheres.size());
    for (const scene::Sphere& sphere : scene.spheres) {
        const auto r = static_cast<double>(sphere.radius);
        radii.smallest = std::min(radii.smallest, r);
        radii.largest = std::max(radii.largest, r);
        radii.mean += r / count;
        cubes += 1 / (r * r * r * count);
    }
    radii.listing = 1 / std::cbrt(cubes);
    radii.classes = classesOf(scene, radii);
    return radii;
}

}  // namespace spherule::sim
