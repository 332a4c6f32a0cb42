#include <algorithm>
#include <optional>

#include "scene/materials.h"
#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

bool anyContact(const scene::Scene& scene, bool (*holds)(const scene::ContactParameters&)) {
    return std::ranges::any_of(scene::actingContactParameters(scene), holds);
}

// For the comparisons of costs.
void addFriction(scene::Scene& scene) {
    for (scene::Material& material : scene.materials) material.friction = 0.3;
}

}  // namespace

// Some contact in the scene has restitution.
const Module moduleRestitution{
    .feature = Feature::Restitution,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return anyContact(scene, [](const auto& contact) { return contact.restitution > 0; });
        },
    .cost = {.reason = "restitution changes the damping, and thereby the substeps of `accurate`"},
};

// Spheres have more than one material: kernels look up the contact parameters by pair of materials.
const Module moduleMaterials{
    .feature = Feature::Materials,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            bool differ = false;
            std::optional<std::uint8_t> first;
            scene::forEachSphere(scene, [&](const scene::Sphere& sphere, double /*weight*/) {
                differ = differ || sphere.material != first.value_or(sphere.material);
                first = sphere.material;
            });
            return differ;
        },
    .declare = [](PlanBuilder& plan) { plan.arrays({Array::ContactParams}); },
    .cost = {.name = "two materials",
             .with =
                 [](scene::Scene& scene) {
                     scene.materials.push_back(scene.materials.front());
                     for (std::size_t k = 0; k < scene.spheres.size(); k += 2) scene.spheres[k].material = 1;
                 }},
};

// Contacts of `accurate` follow Hertz and Mindlin instead of linear springs.
const Module moduleHertz{
    .feature = Feature::Hertz,
    .required =
        [](const scene::Scene& scene, const Features& others) {
            return others.has(Feature::Accurate) &&
                   std::ranges::any_of(scene.materials, [](const scene::Material& m) { return m.young > 0; });
        },
    .cost = {.reason = "with a Young's modulus, contacts and substeps differ"},
};

// Some contact in the scene has friction, so that spheres turn.
const Module moduleFriction{
    .feature = Feature::Friction,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return anyContact(scene, [](const auto& contact) { return contact.friction > 0; });
        },
    .declare = [](PlanBuilder& plan) { plan.arrays({Array::AngularVelocity}); },
    .cost = {.name = "friction", .with = addFriction},
};

// Some contact in the scene resists rolling or spinning.
const Module moduleRolling{
    .feature = Feature::Rolling,
    .required =
        [](const scene::Scene& scene, const Features& others) {
            return others.has(Feature::Friction) && anyContact(scene, [](const scene::ContactParameters& contact) {
                       return contact.rollingResistance > 0 || contact.spinningResistance > 0;
                   });
        },
    .cost = {.name = "rolling resistance",
             .without = addFriction,
             .with =
                 [](scene::Scene& scene) {
                     addFriction(scene);
                     for (scene::Material& material : scene.materials) material.rollingResistance = 0.05;
                 }},
};

}  // namespace spherule::sim
