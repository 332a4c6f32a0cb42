#include "measure/scenes.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "scene/random.h"

namespace spherule::measure {

scene::Scene openSpace(double side) {
    scene::Scene scene;
    scene.bounds.min = glm::dvec3(-side / 2);
    scene.bounds.max = glm::dvec3(side / 2);
    scene.bounds.open.fill(true);
    scene.sleep.enabled = false;
    return scene;
}

scene::Scene closedBox(double side) {
    scene::Scene scene = openSpace(side);
    scene.bounds.open.fill(false);
    scene.forces.gravity = {0, 0, -earth};
    return scene;
}

void setRestitution(scene::Scene& scene, double restitution) {
    for (scene::Material& material : scene.materials) material.restitution = restitution;
}

void setFriction(scene::Scene& scene, double friction) {
    for (scene::Material& material : scene.materials) material.friction = friction;
}

std::uint8_t addMaterial(scene::Scene& scene, const scene::Material& material) {
    scene.materials.push_back(material);
    return static_cast<std::uint8_t>(scene.materials.size() - 1);
}

scene::Sphere& addSphere(scene::Scene& scene, glm::dvec3 position, double radius, glm::dvec3 velocity,
                         std::uint8_t material) {
    scene.spheres.push_back({position, glm::vec3(velocity), static_cast<float>(radius), material});
    return scene.spheres.back();
}

scene::Scene lattice(std::uint32_t count, double radius, double across) {
    const double side = 2 * radius * across;
    const double pitch = 2.2 * radius;
    const auto perRow = static_cast<std::uint32_t>((side - 2 * radius) / pitch) + 1;
    const std::uint32_t layers = (count + perRow * perRow - 1) / (perRow * perRow);
    const double height = pitch * (layers + 1);
    scene::Scene scene = openSpace(side);
    scene.bounds.min.z = -height / 2;
    scene.bounds.max.z = height / 2;
    scene.bounds.open.fill(false);
    scene.bounds.open[scene::ZMax] = true;
    scene.forces.gravity = {0, 0, -earth};
    scene::Random random(1);
    const auto jitter = [&] { return random.uniform(-0.09, 0.09) * radius; };
    const double first = -side / 2 + 1.1 * radius;
    for (std::uint32_t k = 0; k < count; ++k) {
        const glm::dvec3 place(k % perRow, k / perRow % perRow, k / perRow / perRow);
        const glm::dvec3 corner(first, first, -height / 2 + 1.1 * radius);
        const double x = jitter();
        const double y = jitter();
        const double z = jitter();
        addSphere(scene, corner + pitch * place + glm::dvec3(x, y, z), radius);
    }
    return scene;
}

}  // namespace spherule::measure
