#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "scene/load.h"
#include "scene/quality.h"
#include "scene/shapes.h"
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
    scene.contactSums = true;
    scene.obstacles.push_back({scene::planeShape({0, 0, -4}, {0, 0, 1}), 0, ""});
    scene.obstacles.push_back({scene::boxShape({{1, 1, 1}, {2, 2, 2}}), 0, ""});
    for (int k = 0; k < 64; ++k) {
        scene::Sphere sphere;
        sphere.position = {k % 8 - 4, k / 8 - 4, 0};
        sphere.radius = 0.05F + 0.001F * static_cast<float>(k);
        sphere.material = addMaterial(scene, {.restitution = 0.01 * k, .friction = 0.3, .rollingResistance = 0.1});
        scene.spheres.push_back(sphere);
    }
    scene.spheres.back().fixed = true;
    return scene;
}

scene::Scene dust() {
    scene::Scene scene = fineStepSpace(10);
    scene.sphereContacts = false;
    scene.spheres = everything().spheres;
    scene.spheres.back().fixed = false;
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
     {Pass::Grid, Pass::Lists, Pass::ContactMemory, Pass::Begin, Pass::Contacts, Pass::Finish, Pass::Sleep}},
    {scene::Model::Accurate,
     {Pass::Integrate, Pass::Grid, Pass::Lists, Pass::ContactMemory, Pass::Forces, Pass::WallForces}},
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
    // Made by the first pull and the first birth.
    std::set<Array> arrays{Array::Pulls, Array::BirthPlaces, Array::BirthTaken};
    for (const auto& [model, passes] : passesByModel)
        for (const bool periodic : {false, true}) {
            scene::Scene scene = everything(model);
            scene.bounds.periodic[0] = periodic;
            for (const sim::ArraySpec& spec : planOf(scene).arrays) arrays.insert(spec.array);
        }
    for (const sim::ArraySpec& spec : planOf(named("box-4k")).arrays) arrays.insert(spec.array);  // with movers
    for (std::size_t k = 0; k < sim::arrayCount; ++k)
        EXPECT_TRUE(arrays.contains(static_cast<Array>(k))) << nameOf(static_cast<Array>(k));
}

// Without friction, there are no arrays for spins or for the torques of contacts. `accurate` remembers no contacts
// then, and `balanced` only their impulses along the normal.
TEST(Plan, WithoutFrictionHasNoRotation) {
    for (const auto& [model, passes] : passesByModel) {
        const bool balanced = model == scene::Model::Balanced;
        scene::Scene scene = everything(model);
        for (scene::Material& material : scene.materials) material.friction = 0;
        const sim::Plan without = planOf(scene);
        const sim::Plan with = planOf(everything(model));
        EXPECT_TRUE(with.has(Array::AngularVelocity));
        for (const Array array : {Array::AngularVelocity, Array::UnheldSpin, Array::DeltaOmega, Array::TorqueX,
                                  Array::TorqueY, Array::TorqueZ, Array::WallTorque, Array::WallSlip})
            EXPECT_FALSE(without.has(array)) << nameOf(array);
        for (const Array array : {Array::ContactX, Array::ContactY, Array::ContactZ, Array::CarriedCount,
                                  Array::Carried, Array::UnheldVelocity, Array::WallImpulse})
            EXPECT_EQ(without.has(array), balanced) << nameOf(array);
        EXPECT_EQ(dispatches(without, Pass::ContactMemory), balanced);
        EXPECT_LT(without.bytes(), with.bytes());
        EXPECT_FALSE(without.features.has(sim::Feature::Rolling)) << "nothing rolls";
    }
}

const std::vector<Array> arraysOfEveryPlan = {Array::Position,     Array::Velocity,          Array::KeptPosition,
                                              Array::KeptVelocity, Array::KeptIdAndMaterial, Array::IdAndMaterial,
                                              Array::Counters,     Array::SphereSums,        Array::Inspected};

TEST(Plan, WithoutContactsAndForcesOnlyMoves) {
    for (const auto& [model, passes] : passesByModel) {
        const bool balanced = model == scene::Model::Balanced;
        scene::Scene scene = dust();
        scene.quality.model = model;
        const sim::Plan plan = planOf(scene);
        std::vector<Pass> dispatched;
        for (const sim::LaunchSpec& launch : plan.substep) dispatched.push_back(launch.pass);
        // Open faces: check_motion.comp belongs to the last pass.
        EXPECT_EQ(dispatched, balanced ? std::vector({Pass::Begin, Pass::Finish}) : std::vector({Pass::Integrate}));
        std::vector<Array> needed = arraysOfEveryPlan;
        if (balanced)
            needed.insert(needed.end(),
                          {Array::VelocityBefore, Array::UnheldVelocity, Array::AccelerationXz, Array::AccelerationYz});
        if (model == scene::Model::Accurate) needed.push_back(Array::PositionLow);
        for (const Array array : needed) EXPECT_TRUE(plan.has(array)) << nameOf(array);
        EXPECT_EQ(plan.arrays.size(), needed.size());
        EXPECT_LT(plan.bytes(), planOf(everything(model)).bytes() / 4);
    }
}

TEST(Plan, WithoutContactsHasNoGridAndNoLists) {
    scene::Scene scene = everything();
    scene.sphereContacts = false;
    const sim::Plan plan = planOf(scene);
    for (const Pass pass : {Pass::Grid, Pass::Lists, Pass::ContactMemory, Pass::Contacts})
        EXPECT_FALSE(dispatches(plan, pass)) << nameOf(pass);
    for (const Array array : {Array::CellStart, Array::Candidates, Array::Pairs, Array::Bundles, Array::GroupRange,
                              Array::CellOrder, Array::SortScratch, Array::ContactX})
        EXPECT_FALSE(plan.has(array)) << nameOf(array);
    EXPECT_TRUE(dispatches(plan, Pass::Finish));
    EXPECT_TRUE(plan.has(Array::WallImpulse)) << "walls remain";
    EXPECT_LT(plan.bytes(), planOf(everything()).bytes());
}

TEST(Plan, WithoutSleepHasNoSleepPass) {
    scene::Scene scene = everything();
    scene.sleep.enabled = false;
    EXPECT_FALSE(dispatches(planOf(scene), Pass::Sleep));
    for (const Array array : {Array::RestReference, Array::ActiveBlock})
        EXPECT_FALSE(planOf(scene).has(array)) << nameOf(array);
    EXPECT_LT(planOf(scene).bytes(), planOf(everything()).bytes());
    scene.quality.model = scene::Model::Fast;
    EXPECT_FALSE(planOf(scene).has(Array::VelocityBefore)) << "in `fast` only sleep asks for the velocity before";
    scene.sleep.enabled = true;
    EXPECT_TRUE(planOf(scene).has(Array::VelocityBefore));
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
    const std::vector<std::pair<scene::Model, Pass>> wallPasses = {{scene::Model::Fast, Pass::WallImpulses},
                                                                   {scene::Model::Accurate, Pass::WallForces}};
    for (const auto& [model, pass] : wallPasses) {
        scene::Scene scene = everything(model);
        scene.bounds.open.fill(true);
        scene.obstacles.clear();
        const sim::Plan plan = planOf(scene);
        EXPECT_FALSE(dispatches(plan, pass));
        EXPECT_FALSE(plan.has(Array::Obstacles));
        scene.bounds.open[scene::ZMin] = false;
        EXPECT_TRUE(dispatches(planOf(scene), pass));
        EXPECT_FALSE(planOf(scene).has(Array::Obstacles)) << "faces are no obstacles";
    }
}

// `balanced` solves walls where it moves the spheres, in one kernel.
TEST(Plan, WithoutWallsRemembersNoWalls) {
    scene::Scene scene = everything();
    scene.bounds.open.fill(true);
    scene.obstacles.clear();
    for (const Array array : {Array::Obstacles, Array::WallImpulse, Array::WallTorque})
        EXPECT_FALSE(planOf(scene).has(array)) << nameOf(array);
    scene.bounds.open[scene::ZMin] = false;
    EXPECT_FALSE(planOf(scene).has(Array::Obstacles)) << "faces are no obstacles";
    for (const Array array : {Array::WallImpulse, Array::WallTorque})
        EXPECT_TRUE(planOf(scene).has(array)) << nameOf(array);
}

// The memory of contacts is scaled when the length of the substep changes.
TEST(Plan, OnlyBalancedScalesItsMemory) {
    for (const auto& [model, passes] : passesByModel)
        EXPECT_EQ(planOf(everything(model)).newSubstep.size(), model == scene::Model::Balanced ? 2U : 0U);
    EXPECT_EQ(planOf(dust()).newSubstep.size(), 1U) << "no pairs";
}

// A whole number of cells fits a periodic axis, a multiple of two blocks. Other axes have cubes.
TEST(Plan, FitsCellsToPeriodicAxes) {
    scene::Scene scene = everything();
    scene.obstacles.clear();
    EXPECT_FALSE(planOf(scene).has(Array::Images));
    for (const double length : {1.5, 2.9, 3.0, 7.77, 10.0}) {
        scene.bounds.min.x = -length / 2;
        scene.bounds.max.x = length / 2;
        scene.bounds.periodic = {true, false, false};
        const sim::Plan plan = planOf(scene);
        EXPECT_TRUE(plan.has(Array::Images));
        EXPECT_EQ(plan.periods, glm::dvec3(length, 0, 0));
        for (const sim::Level& level : plan.grid.levels) {
            EXPECT_EQ(level.cells.x % 8, 0U);
            EXPECT_DOUBLE_EQ(level.cells.x * level.widths.x, length);
            EXPECT_DOUBLE_EQ(level.widths.y, level.widths.z);
            EXPECT_FLOAT_EQ(level.cellSize, static_cast<float>(level.widths.y));
            const bool fits = level.widths.x >= level.widths.y;
            EXPECT_EQ(sim::checkPeriods(scene.bounds, plan.grid).has_value(), fits) << length;
            EXPECT_EQ(fits, length > 2);
        }
        EXPECT_NE(sim::planText(scene, plan, {}).find(fmt::format("periodic   X every {:.4g} m", length)),
                  std::string::npos);
    }
    scene.sphereContacts = false;
    EXPECT_TRUE(planOf(scene).has(Array::Images));
}

// NVIDIA's drivers show a kernel at most 2^31 - 1 bytes of a buffer. The most spheres fit, with all features, and with
// lists that have grown once.
TEST(Plan, KeepsArraysOfTheMostSpheresWithinABlock) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate}) {
        scene::Scene scene = everything(model);
        for (int k = 0; k < 6; ++k) scene.obstacles.push_back({scene::boxShape({{1, 1, 1}, {2, 2, 2}}), 0, ""});
        const sim::RadiusStats radii = sim::radiusStatsOf(scene);
        const sim::Features features = sim::featuresOf(scene);
        const sim::Plan fresh = sim::planFor(scene, features, scene::maxSpheres, radii);
        const sim::Plan grown = sim::planFor(scene, features, scene::maxSpheres, radii, 2 * fresh.pairCapacity);
        for (const sim::ArraySpec& spec : grown.arrays)
            EXPECT_LT(spec.bytes, std::uint64_t{1} << 31U) << sim::nameOf(spec.array) << " in " << scene::nameOf(model);
    }
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
    for (const Pass pass : {Pass::Begin, Pass::Finish})
        EXPECT_GT(seconds.at(static_cast<std::size_t>(pass)), 0) << nameOf(pass);
    for (const Pass pass : {Pass::Integrate, Pass::Grid, Pass::Lists, Pass::Contacts, Pass::Sleep})
        if (static_cast<std::size_t>(pass) < seconds.size()) {
            EXPECT_EQ(seconds[static_cast<std::size_t>(pass)], 0) << nameOf(pass);
        }
}

}  // namespace
}  // namespace spherule::physics
