#include "scene/features.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace spherule::scene {

namespace {

bool differ(const std::vector<Sphere>& spheres, auto quantity) {
    return std::any_of(spheres.begin(), spheres.end(),
                       [&](const Sphere& s) { return quantity(s) != quantity(spheres.front()); });
}

bool bounces(const Scene& scene) {
    const auto any = [](const auto& list) {
        return std::any_of(list.begin(), list.end(), [](const auto& item) { return item.restitution > 0; });
    };
    return scene.restitution > 0 || scene.bounds.restitution > 0 || any(scene.spheres) || any(scene.obstacles);
}

template <class Shape>
bool has(const Scene& scene) {
    return std::any_of(scene.obstacles.begin(), scene.obstacles.end(),
                       [](const Obstacle& o) { return std::holds_alternative<Shape>(o.shape); });
}

}  // namespace

Features featuresOf(const Scene& scene) {
    const auto& open = scene.bounds.open;
    return {
        .gravity = glm::length(scene.gravity) > 0,
        .contacts = scene.sphereContacts,
        .radii = differ(scene.spheres, [](const Sphere& s) { return s.radius; }),
        .restitution = bounces(scene),
        .restitutions = differ(scene.spheres, [](const Sphere& s) { return s.restitution; }),
        .walls = !std::all_of(open.begin(), open.end(), [](bool face) { return face; }),
        .planes = has<Plane>(scene),
        .boxes = has<Box>(scene),
        // Without gravity nothing rests: what is slow only drifts. Without contacts there is nothing that sleep saves.
        .sleep = scene.sleep.enabled && scene.sphereContacts && glm::length(scene.gravity) > 0,
    };
}

}  // namespace spherule::scene
