#include "scene/forces.h"

#include <algorithm>

#include "scene/scene.h"

namespace spherule::scene {

double strongestAcceleration(const Scene& scene) {
    constexpr std::size_t mostPlaces = 10'000;  // about a millisecond
    double strongest = glm::length(scene.forces.gravity);
    double shaken = 0;  // spheres that obstacles carry
    for (const Obstacle& obstacle : scene.obstacles)
        if (obstacle.motion) shaken = std::max(shaken, obstacle.motion->speeds().acceleration);
    strongest += shaken;
    const auto attracts = [](const Field& field) { return std::holds_alternative<Attraction>(field); };
    if (std::ranges::none_of(scene.forces.fields, attracts)) return strongest;
    const std::size_t stride = scene.spheres.size() / mostPlaces + 1;
    for (std::size_t id = 0; id < scene.spheres.size(); id += stride)
        if (!scene.spheres[id].fixed)
            strongest = std::max(strongest, glm::length(scene.forces.accelerationAt(scene.spheres[id].position)));
    for (const Emitter& emitter : scene.emitters)
        for (const Sphere& sphere : emitter.samples)
            strongest = std::max(strongest, glm::length(scene.forces.accelerationAt(sphere.position)));
    return strongest;
}

}  // namespace spherule::scene
