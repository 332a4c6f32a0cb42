#include "scene/features.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "scene/materials.h"

namespace spherule::scene {

namespace {

bool differ(const std::vector<Sphere>& spheres, auto quantity) {
    return std::any_of(spheres.begin(), spheres.end(),
                       [&](const Sphere& s) { return quantity(s) != quantity(spheres.front()); });
}

template <class Shape>
bool has(const Scene& scene) {
    return std::any_of(scene.obstacles.begin(), scene.obstacles.end(),
                       [](const Obstacle& o) { return std::holds_alternative<Shape>(o.shape); });
}

}  // namespace

Features featuresOf(const Scene& scene) {
    const std::vector<PairLaw> laws = actingLaws(scene);
    const bool friction = std::ranges::any_of(laws, [](const PairLaw& law) { return law.friction > 0; });
    const bool accurate = scene.quality.model == Model::Accurate;
    return {
        .gravity = glm::length(scene.gravity) > 0,
        .contacts = scene.sphereContacts,
        .radii = differ(scene.spheres, [](const Sphere& s) { return s.radius; }),
        .restitution = std::ranges::any_of(laws, [](const PairLaw& law) { return law.restitution > 0; }),
        .materials = differ(scene.spheres, [](const Sphere& s) { return s.material; }),
        .friction = friction,
        .rolling = friction && std::ranges::any_of(laws,
                                                   [](const PairLaw& law) {
                                                       return law.rollingResistance > 0 || law.spinningResistance > 0;
                                                   }),
        .hertz = accurate && std::ranges::any_of(scene.materials, [](const Material& m) { return m.young > 0; }),
        .walls = hasWalls(scene),
        .planes = has<Plane>(scene),
        .boxes = has<Box>(scene),
        // Without gravity nothing rests: what is slow only drifts. Without contacts there is nothing that sleep saves.
        // Under forces nothing is put to sleep: `accurate` is for those who want to see them.
        .sleep = scene.sleep.enabled && scene.sphereContacts && glm::length(scene.gravity) > 0 && !accurate,
        .model = scene.quality.model,
    };
}

}  // namespace spherule::scene
