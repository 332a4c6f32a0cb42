#include "mixed.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>

#include "scene/random.h"

namespace spherule::physics {

namespace {

bool overlapsAny(const scene::Scene& scene, const scene::Sphere& one) {
    return std::ranges::any_of(scene.spheres, [&](const scene::Sphere& other) {
        return glm::distance(one.position, other.position) < static_cast<double>(one.radius + other.radius);
    });
}

}  // namespace

void scatterMixed(scene::Scene& scene, std::uint32_t count, double largest, double ratio, std::uint64_t seed) {
    scene::Random random(seed);
    std::vector<double> radii{largest, largest / ratio};
    while (radii.size() < count) radii.push_back(largest * std::pow(ratio, -std::sqrt(random.uniform(0.02, 1))));
    std::ranges::sort(radii, std::greater<>());
    for (const double radius : radii) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(radius);
        int tries = 0;
        do {
            if (++tries > 10000) throw std::runtime_error("there is no room for so many spheres");
            for (int axis = 0; axis < 3; ++axis)
                sphere.position[axis] =
                    random.uniform(scene.bounds.min[axis] + radius, scene.bounds.max[axis] - radius);
        } while (overlapsAny(scene, sphere));
        scene.spheres.push_back(sphere);
    }
}

scene::Scene bedUnderOne(std::uint32_t count, double ratio) {
    const double least = ratio > 1 ? 0.005 : 0.012;
    const double most = ratio > 1 ? 0.02 : 0.012;
    const double large = least * ratio;
    const double spacing = 2.02 * most;
    const double side = std::max(2.4 * large, std::cbrt(count) * spacing);
    const int perRow = static_cast<int>(side / spacing);
    const int layers = (static_cast<int>(count) + perRow * perRow - 1) / (perRow * perRow);
    scene::Scene scene = fineStepBox(side);
    scene.bounds.max.z = scene.bounds.min.z + layers * spacing + 2.2 * large;
    scene.step = 1.0 / 60;
    scene.quality.substeps = 8;
    scene::Random random(5);
    for (int k = 0; k < static_cast<int>(count); ++k) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(most > least ? random.uniform(least, most) : least);
        const glm::dvec3 place(k % perRow, k / perRow % perRow, k / (perRow * perRow));
        sphere.position = scene.bounds.min + (place + 0.5) * spacing;
        for (int axis = 0; axis < 2; ++axis) sphere.position[axis] += random.uniform(-0.005, 0.005) * spacing;
        scene.spheres.push_back(sphere);
    }
    if (ratio > 1) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(large);
        sphere.position = {0, 0, scene.bounds.min.z + layers * spacing + large};
        scene.spheres.push_back(sphere);
    }
    return scene;
}

}  // namespace spherule::physics
