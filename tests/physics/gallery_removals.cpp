#include "gallery_removals.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "scene/shapes.h"

namespace spherule::physics {
namespace {

using Change = std::function<void(scene::Scene&)>;

template <class Elements>
Change erasing(Elements scene::Scene::*member, std::size_t number) {
    return [=](scene::Scene& scene) {
        auto& all = scene.*member;
        all.erase(all.begin() + static_cast<std::ptrdiff_t>(number));
    };
}

Change ofMaterials(const std::function<void(scene::Material&)>& change) {
    return [=](scene::Scene& scene) {
        std::ranges::for_each(scene.materials, change);
        scene.pairs.clear();
    };
}

Change ofObstacles(void (*change)(scene::Obstacle&)) {
    return [=](scene::Scene& scene) { std::ranges::for_each(scene.obstacles, change); };
}

Change ofFields(void (*change)(scene::Field&)) {
    return [=](scene::Scene& scene) { std::ranges::for_each(scene.forces.fields, change); };
}

void addFields(std::vector<Removal>& removals, const scene::Scene& scene) {
    for (std::size_t k = 0; k < scene.forces.fields.size(); ++k)
        removals.push_back({fmt::format("fields[{}]", k), [k](scene::Scene& from) {
                                auto& fields = from.forces.fields;
                                fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(k));
                            }});
    const auto hasRegion = [](const scene::Field& field) { return scene::regionOf(field).has_value(); };
    if (std::ranges::any_of(scene.forces.fields, hasRegion))
        removals.push_back({"regions of fields", ofFields([](scene::Field& field) {
                                std::visit([](auto& kind) { kind.region.reset(); }, field);
                            })});
    const auto hasVortex = [](const scene::Field& field) {
        const auto* const drag = std::get_if<scene::Drag>(&field);
        return drag != nullptr && drag->vortex;
    };
    if (std::ranges::any_of(scene.forces.fields, hasVortex))
        removals.push_back({"vortices", ofFields([](scene::Field& field) {
                                if (auto* const drag = std::get_if<scene::Drag>(&field)) drag->vortex.reset();
                            })});
}

void addObstacles(std::vector<Removal>& removals, const scene::Scene& scene) {
    std::set<scene::ShapeKind> kinds;
    for (const scene::Obstacle& obstacle : scene.obstacles) kinds.insert(obstacle.shape->kind());
    for (const scene::ShapeKind kind : kinds)
        removals.push_back({fmt::format("obstacles of kind {}", static_cast<int>(kind)), [kind](scene::Scene& from) {
                                std::erase_if(from.obstacles, [kind](const scene::Obstacle& obstacle) {
                                    return obstacle.shape->kind() == kind;
                                });
                            }});
    if (std::ranges::any_of(scene.obstacles, [](const scene::Obstacle& one) { return one.motion.has_value(); }))
        removals.push_back({"motion", ofObstacles([](scene::Obstacle& obstacle) { obstacle.motion.reset(); })});
    if (std::ranges::any_of(scene.obstacles,
                            [](const scene::Obstacle& one) { return one.motion && one.motion->drive; }))
        removals.push_back({"drives", ofObstacles([](scene::Obstacle& obstacle) {
                                if (obstacle.motion) obstacle.motion->drive.reset();
                            })});
}

void addFaces(std::vector<Removal>& removals, const scene::Scene& scene) {
    const scene::Bounds& bounds = scene.bounds;
    bool walled = false;
    for (std::size_t face = 0; face < 6; ++face) walled = walled || bounds.walled(face);
    if (!walled) return;
    if (bounds.anyPeriodic())
        removals.push_back({"periodic axes", [](scene::Scene& from) { from.bounds.periodic.fill(false); }});
    if (std::ranges::find(bounds.open, true) != bounds.open.end())
        removals.push_back({"open faces", [](scene::Scene& from) { from.bounds.open.fill(false); }});
}

void removeFixed(scene::Scene& scene) {
    std::vector<std::uint32_t> fixed;
    for (std::uint32_t k = 0; k < scene.spheres.size(); ++k)
        if (scene.spheres[k].fixed) fixed.push_back(k);
    scene::removeSpheres(scene, fixed);
}

void addSpheres(std::vector<Removal>& removals, const scene::Scene& scene) {
    if (std::ranges::any_of(scene.spheres, &scene::Sphere::fixed)) removals.push_back({"fixed spheres", removeFixed});
    float smallest = 0;
    float largest = 0;
    scene::forEachSphere(scene, [&](const scene::Sphere& sphere, double /*weight*/) {
        smallest = smallest == 0 ? sphere.radius : std::min(smallest, sphere.radius);
        largest = std::max(largest, sphere.radius);
    });
    if (smallest < largest)  // the cells follow the largest
        removals.push_back({"several radii", [largest](scene::Scene& from) {
                                for (scene::Sphere& sphere : from.spheres) sphere.radius = largest;
                                for (scene::Emitter& emitter : from.emitters)
                                    for (scene::Sphere& sample : emitter.samples) sample.radius = largest;
                            }});
}

}  // namespace

std::vector<Removal> removalsFrom(const scene::Scene& scene) {
    std::vector<Removal> removals;
    addFields(removals, scene);
    // Samples of their spheres stay, because the cells of the grid follow the radii.
    if (!scene.emitters.empty())
        removals.push_back({"emitters", [](scene::Scene& from) {
                                for (const scene::Emitter& emitter : from.emitters)
                                    from.spheres.insert(from.spheres.end(), emitter.samples.begin(),
                                                        emitter.samples.end());
                                from.emitters.clear();
                            }});
    for (std::size_t k = 0; k < scene.sinks.size(); ++k)
        removals.push_back({fmt::format("sinks[{}]", k), erasing(&scene::Scene::sinks, k)});
    addObstacles(removals, scene);
    addFaces(removals, scene);
    addSpheres(removals, scene);
    removals.push_back({"pairs", [](scene::Scene& from) { from.pairs.clear(); }});
    removals.push_back({"friction", ofMaterials([](scene::Material& material) { material.friction = 0; })});
    removals.push_back({"rolling and spinning resistance", ofMaterials([](scene::Material& material) {
                            material.rollingResistance = material.spinningResistance = 0;
                        })});
    removals.push_back({"restitution", ofMaterials([](scene::Material& material) { material.restitution = 0; })});
    removals.push_back({"gravity", [](scene::Scene& from) { from.forces.gravity = {}; }});
    removals.push_back({"sleep", [](scene::Scene& from) { from.sleep.enabled = false; }});
    removals.push_back({"contact sums", [](scene::Scene& from) { from.contactSums = false; }});
    removals.push_back({"contacts", [](scene::Scene& from) { from.sphereContacts = false; }});
    return removals;
}

}  // namespace spherule::physics
