// Each part of a scene has its own costs: without a part, a plan has no more bytes, passes or launches.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>

#include <fmt/format.h>

#include "gallery_scenes.h"
#include "scene/shapes.h"
#include "sim/plan.h"
#include "support.h"

namespace spherule::physics {
namespace {

struct Cost {
    std::uint64_t bytes = 0;
    std::set<sim::Pass> passes;
    std::size_t launches = 0;  // of a substep, of a new length of it, of the end of a step, and of births
    sim::SubstepCost quiet;
    sim::SubstepCost rebuilding;
};

Cost costOf(const scene::Scene& scene, std::uint32_t spheres) {
    const sim::Plan plan = sim::planFor(scene, sim::featuresOf(scene), spheres, sim::radiusStatsOf(scene));
    Cost cost{.bytes = plan.bytes(),
              .passes = {},
              .launches = plan.substep.size() + plan.newSubstep.size() + plan.stepEnd.size() + plan.births.size(),
              .quiet = sim::costOf(plan, false),
              .rebuilding = sim::costOf(plan, true)};
    for (const sim::LaunchSpec& launch : plan.substep) cost.passes.insert(launch.pass);
    return cost;
}

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

// A change that takes a part away, with its name. Walls are none: an open face has costs of its own.
struct Removal {
    std::string part;
    Change change;
};

std::vector<Removal> removalsFrom(const scene::Scene& scene) {
    std::vector<Removal> removals;
    for (std::size_t k = 0; k < scene.forces.fields.size(); ++k)
        removals.push_back({fmt::format("fields[{}]", k), [k](scene::Scene& from) {
                                auto& fields = from.forces.fields;
                                fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(k));
                            }});
    // Samples of their spheres stay, because the cells of the grid follow the radii.
    removals.push_back({"emitters", [](scene::Scene& from) {
                            for (const scene::Emitter& emitter : from.emitters)
                                from.spheres.insert(from.spheres.end(), emitter.samples.begin(), emitter.samples.end());
                            from.emitters.clear();
                        }});
    for (std::size_t k = 0; k < scene.sinks.size(); ++k)
        removals.push_back({fmt::format("sinks[{}]", k), erasing(&scene::Scene::sinks, k)});
    std::set<scene::ShapeKind> kinds;
    for (const scene::Obstacle& obstacle : scene.obstacles) kinds.insert(obstacle.shape->kind());
    for (const scene::ShapeKind kind : kinds)
        removals.push_back({fmt::format("obstacles of kind {}", static_cast<int>(kind)), [kind](scene::Scene& from) {
                                std::erase_if(from.obstacles, [kind](const scene::Obstacle& obstacle) {
                                    return obstacle.shape->kind() == kind;
                                });
                            }});
    removals.push_back({"motion", [](scene::Scene& from) {
                            for (scene::Obstacle& obstacle : from.obstacles) obstacle.motion.reset();
                        }});
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

class GalleryPlan : public testing::TestWithParam<std::string> {};

TEST_P(GalleryPlan, WithoutAPartCostsNoMore) {
    const scene::Scene whole = reduced(named(GetParam()), 2'000);
    const auto spheres = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(whole.spheres.size()));
    const Cost with = costOf(whole, spheres);
    for (const Removal& removal : removalsFrom(whole)) {
        scene::Scene part = whole;
        removal.change(part);
        const Cost without = costOf(part, spheres);
        EXPECT_LE(without.bytes, with.bytes) << removal.part;
        EXPECT_LE(without.launches, with.launches) << removal.part;
        EXPECT_LE(without.passes.size(), with.passes.size()) << removal.part;
        for (const auto cost : {&Cost::quiet, &Cost::rebuilding}) {
            EXPECT_LE((without.*cost).launches, (with.*cost).launches) << removal.part;
            EXPECT_LE((without.*cost).barriers, (with.*cost).barriers) << removal.part;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, GalleryPlan, testing::ValuesIn(galleryScenes()), testNameOf);

}  // namespace
}  // namespace spherule::physics
