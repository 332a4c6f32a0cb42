// Spheres that overlap deeply at the start separate without gaining speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "measure/scenes.h"
#include "scene/quality.h"
#include "sim/initial_overlaps.h"
#include "support.h"

namespace spherule::physics {
namespace {

std::string noticesOf(sim::Simulation& simulation) {
    std::string all;
    for (const std::string& notice : simulation.takeNotices()) all += notice + "\n";
    return all;
}

TEST(InitialOverlaps, SpheresAtOnePointSeparateSlowlyInEveryModel) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate}) {
        scene::Scene scene = fineStepBox(4);
        scene.forces.gravity = {};
        scene.step = 1.0 / 60;
        scene.quality.model = model;
        ASSERT_TRUE(scene::fitSubsteps(scene));
        for (int k = 0; k < 200; ++k) measure::addSphere(scene, {0.3, 0.2, 0.1}, 0.05);
        const auto simulation = simulate(scene);
        EXPECT_EQ(noticesOf(*simulation).find("in each other by up to") != std::string::npos,
                  model != scene::Model::Fast);
        run(*simulation, model == scene::Model::Fast ? 1 : 0.1);
        const sim::Statistics after = simulation->statistics();
        EXPECT_LT(after.speedMax, 0.5) << scene::nameOf(model);
        EXPECT_LT(after.overlapMax, 0.5) << scene::nameOf(model);
    }
}

TEST(InitialOverlaps, CompressedBedRisesSlowlyAfterAChangeToSprings) {
    scene::Scene scene = measure::lattice(600, 0.05, 6);
    scene.bounds.open.fill(false);
    scene.step = 1.0 / 60;
    scene.quality = {.model = scene::Model::Fast, .substeps = 1, .substepsFixed = true};
    const auto simulation = simulate(scene);
    run(*simulation, 2);
    const sim::Statistics squeezed = simulation->statistics();
    static_cast<void>(noticesOf(*simulation));
    ASSERT_TRUE(simulation->apply(sim::Set{.model = scene::Model::Accurate}));
    ASSERT_GT(squeezed.overlapMax, 2 * sim::maxSafeOverlap(simulation->scene())) << "not squeezed";
    EXPECT_NE(noticesOf(*simulation).find("moved apart beforehand"), std::string::npos);
    double fastest = 0;
    for (int k = 0; k < 6; ++k) {
        run(*simulation, scene.step);
        fastest = std::max(fastest, simulation->statistics().speedMax);
    }
    RecordProperty("fastest", std::to_string(fastest));
    EXPECT_LT(fastest, std::sqrt(2 * earth * 0.5)) << "faster than from half a metre";
}

}  // namespace
}  // namespace spherule::physics
