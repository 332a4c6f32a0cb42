#include "scene/forces.h"

#include <algorithm>

#include "scene/scene.h"

namespace spherule::scene {

double strongestAcceleration(const Scene& scene) {
    double strongest = glm::length(scene.forces.gravity);
    if (scene.forces.fields.empty()) return strongest;
    for (const Sphere& sphere : scene.spheres)
        strongest = std::max(strongest, glm::length(scene.forces.accelerationAt(sphere.position)));
    return strongest;
}

}  // namespace spherule::scene
