#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sim/plan.h"
#include "support.h"

// Arrays and passes that a scene does not need are neither allocated nor dispatched.
namespace spherule::physics {
namespace {

using sim::Array;
using sim::Pass;

sim::Plan planOf(const scene::Scene& scene) {
    return sim::planFor(scene, sim::featuresOf(scene), static_cast<std::uint32_t>(scene.spheres.size()),
                        sim::radiusStatsOf(scene));
}

bool dispatches(const sim::Plan& plan, Pass pass) {
    return std::ranges::any_of(plan.substep, [pass](const sim::LaunchSpec& launch) { return launch.pass == pass; });
}

// 64 spheres, in a scene that uses all features.
scene::Scene everything(scene::Model model = scene::Model::Balanced) {
    scene::Scene scene = fineStepBox(10);
    scene.quality.model = model;
    scene.sleep.enabled = true;
    scene.obstacles.push_back({scene::Plane{{0, 0, -4}, {0, 0, 1}}, 0, ""});
    scene.obstacles.push_back({scene::Box{{1, 1, 1}, {2, 2, 2}}, 0, ""});
    for (int k = 0; k < 64; ++k) {
        scene::Sphere sphere;
        sphere.position = {k % 8 - 4, k / 8 - 4, 0};
        sphere.radius = 0.05F + 0.001F * static_cast<float>(k);
        sphere.material = addMaterial(scene, {.restitution = 0.01 * k, .friction = 0.3, .rollingResistance = 0.1});
        scene.spheres.push_back(sphere);
    }
    return scene;
}

scene::Scene dust() {
    scene::Scene scene = fineStepSpace(10);
    scene.sphereContacts = false;
    scene.spheres = everything().spheres;
    for (scene::Sphere& sphere : scene.spheres) {
        sphere.radius = 0.05F;
        sphere.material = 0;
    }
    setRestitution(scene, 0);
    return scene;
}

const std::vector<std::pair<scene::Model, std::set<Pass>>> passesByModel = {
    {scene::Model::Fast, {Pass::Integrate, Pass::Grid, Pass::Lists, Pass::Impulses, Pass::WallImpulses, Pass::Sleep}},
    {scene::Model::Balanced,
     {Pass::Integrate, Pass::Grid, Pass::Lists, Pass::Positions, Pass::WallPositions, Pass::Velocities,
      Pass::WallVelocities, Pass::Friction, Pass::WallFriction, Pass::Sleep}},
    {scene::Model::Accurate,
     {Pass::Integrate, Pass::Grid, Pass::Lists, Pass::SlipMemory, Pass::Forces, Pass::WallForces}},
};

TEST(Plan, WithAllFeaturesHasExactlyThePassesOfItsModel) {
    for (const auto& [model, passes] : passesByModel) {
        const sim::Plan plan = planOf(everything(model));
        for (unsigned k = 0; k < sim::passCount; ++k) {
            const auto pass = static_cast<Pass>(k);
            if (pass == Pass::Statistics || pass == Pass::Pack) continue;
            EXPECT_EQ(dispatches(plan, pass), passes.contains(pass)) << nameOf(pass);
        }
    }
}

TEST(Plan, WithAllFeaturesInAllModelsHasEveryArray) {
    std::set<Array> arrays;
    for (const auto& [model, passes] : passesByModel)
        for (const sim::ArraySpec& spec : planOf(everything(model)).arrays) arrays.insert(spec.array);
    for (std::size_t k = 0; k < sim::arrayCount; ++k)
        EXPECT_TRUE(arrays.contains(static_cast<Array>(k))) << nameOf(static_cast<Array>(k));
}

// Without friction, there are no arrays for spins, for impulses of pairs and walls, or for the slip of contacts. There
// are no passes that read them either.
TEST(Plan, WithoutFrictionHasNoRotationAndNoContactHistory) {
    for (const auto& [model, passes] : passesByModel) {
        scene::Scene scene = everything(model);
        for (scene::Material& material : scene.materials) material.friction = 0;
        const sim::Plan without = planOf(scene);
        const sim::Plan with = planOf(everything(model));
        EXPECT_TRUE(with.has(Array::AngularVelocity));
        for (const Array array : {Array::AngularVelocity, Array::DeltaOmega, Array::NormalImpulses, Array::WallImpulse,
                                  Array::TangentialSlip, Array::CarriedSlip, Array::CarriedOffsets, Array::WallSlip})
            EXPECT_FALSE(without.has(array)) << nameOf(array);
        for (const Pass pass : {Pass::Friction, Pass::WallFriction, Pass::SlipMemory})
            EXPECT_FALSE(dispatches(without, pass)) << nameOf(pass);
        EXPECT_LT(without.bytes(), with.bytes());
        EXPECT_FALSE(without.features.has(sim::Feature::Rolling)) << "nothing rolls";
    }
}

TEST(Plan, WithoutContactsAndForcesOnlyIntegrates) {
    const sim::Plan plan = planOf(dust());
    ASSERT_EQ(plan.substep.size(), 1U);
    EXPECT_EQ(plan.substep[0].pass, Pass::Integrate);
    for (const Array needed :
         {Array::Position, Array::Velocity, Array::IdAndMaterial, Array::Counters, Array::SphereSums})
        EXPECT_TRUE(plan.has(needed)) << nameOf(needed);
    EXPECT_EQ(plan.arrays.size(), 5U);
    EXPECT_LT(plan.bytes(), planOf(everything()).bytes() / 4);
}

TEST(Plan, WithoutContactsHasNoGridAndNoLists) {
    scene::Scene scene = everything();
    scene.sphereContacts = false;
    const sim::Plan plan = planOf(scene);
    for (const Pass pass : {Pass::Grid, Pass::Lists, Pass::Positions, Pass::Velocities})
        EXPECT_FALSE(dispatches(plan, pass)) << nameOf(pass);
    for (const Array array : {Array::CellStart, Array::Pairs, Array::GroupRange, Array::CellOrder, Array::SortScratch})
        EXPECT_FALSE(plan.has(array)) << nameOf(array);
    EXPECT_TRUE(dispatches(plan, Pass::WallPositions));
    EXPECT_LT(plan.bytes(), planOf(everything()).bytes());
}

TEST(Plan, WithoutSleepHasNoSleepPass) {
    scene::Scene scene = everything();
    scene.sleep.enabled = false;
    EXPECT_FALSE(dispatches(planOf(scene), Pass::Sleep));
    setRestitution(scene, 0);
    scene.sphereContacts = false;
    EXPECT_FALSE(planOf(scene).has(Array::VelocityBefore)) << "only impacts and sleep ask for the velocity before";
    EXPECT_LT(planOf(scene).bytes(), planOf(everything()).bytes());
}

TEST(Plan, WithOneMaterialInEmptySpaceHasNoContactTable) {
    scene::Scene scene = everything();
    scene.bounds.open.fill(true);
    scene.obstacles.clear();
    EXPECT_TRUE(planOf(scene).has(Array::ContactParams));
    for (scene::Sphere& sphere : scene.spheres) sphere.material = 0;
    EXPECT_FALSE(planOf(scene).has(Array::ContactParams));
}

TEST(Plan, WithoutWallsHasNoWallPass) {
    scene::Scene scene = everything();
    scene.bounds.open.fill(true);
    scene.obstacles.clear();
    const sim::Plan plan = planOf(scene);
    EXPECT_FALSE(dispatches(plan, Pass::WallPositions));
    EXPECT_FALSE(dispatches(plan, Pass::WallVelocities));
    EXPECT_FALSE(plan.has(Array::Obstacles));
    scene.bounds.open[scene::ZMin] = false;
    EXPECT_TRUE(dispatches(planOf(scene), Pass::WallPositions));
    EXPECT_FALSE(planOf(scene).has(Array::Obstacles)) << "faces are no obstacles";
}

TEST(Plan, DetectsUseOfGravityAndRadii) {
    EXPECT_TRUE(planOf(everything()).features.has(sim::Feature::Gravity));
    EXPECT_TRUE(planOf(everything()).features.has(sim::Feature::Radii));
    EXPECT_FALSE(planOf(dust()).features.has(sim::Feature::Gravity));
    EXPECT_FALSE(planOf(dust()).features.has(sim::Feature::Radii));
}

// The simulation allocates the arrays of the plan, and runs the passes of the plan.
TEST(Plan, DeterminesAllocatedArraysAndTimedPasses) {
    const auto simulation = simulate(dust());
    EXPECT_EQ(simulation->plan().bytes(), planOf(dust()).bytes());
    EXPECT_TRUE(simulation->pipeline().read<std::uint32_t>(Array::Pairs).empty());
    static_cast<void>(simulation->passSeconds());  // discards the times of other tests
    run(*simulation, 0.1);
    const std::vector<double> seconds = simulation->passSeconds();
    EXPECT_GT(seconds.at(static_cast<std::size_t>(Pass::Integrate)), 0);
    for (const Pass pass : {Pass::Grid, Pass::Lists, Pass::Positions, Pass::Velocities, Pass::Sleep})
        if (static_cast<std::size_t>(pass) < seconds.size()) {
            EXPECT_EQ(seconds[static_cast<std::size_t>(pass)], 0) << nameOf(pass);
        }
}

}  // namespace
}  // namespace spherule::physics
