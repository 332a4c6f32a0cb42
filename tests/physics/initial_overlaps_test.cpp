// Spheres that overlap deeply at the start separate without gaining speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

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

// Returns the largest speed (m/s) after a bed of `spheres`, squeezed by `fast` for `seconds`, gets springs.
double speedOfSprings(unsigned spheres, double seconds) {
    scene::Scene scene = measure::lattice(spheres, 0.05, 6);
    scene.bounds.open.fill(false);
    scene.step = 1.0 / 60;
    scene.quality = {.model = scene::Model::Fast, .substeps = 1, .substepsFixed = true};
    const auto simulation = simulate(scene);
    run(*simulation, seconds);
    const sim::Statistics squeezed = simulation->statistics();
    static_cast<void>(noticesOf(*simulation));
    if (!simulation->apply(sim::Set{.model = scene::Model::Accurate})) throw std::runtime_error("refused");
    EXPECT_GT(squeezed.overlapMax, 2 * sim::maxSafeOverlap(simulation->scene())) << "not squeezed";
    EXPECT_NE(noticesOf(*simulation).find("moved apart beforehand"), std::string::npos);
    double fastest = 0;
    for (int k = 0; k < 6; ++k) {
        run(*simulation, scene.step);
        fastest = std::max(fastest, simulation->statistics().speedMax);
    }
    return fastest;
}

// The fastest of 600 spheres in a squeezed bed is a matter of chance: 1.5 to 4.3 m/s.
TEST(InitialOverlaps, CompressedBedsRiseSlowlyAfterAChangeToSprings) {
    std::vector<double> speeds;
    for (const unsigned spheres : {590U, 595U, 600U, 605U, 610U, 615U})
        for (const double seconds : {1.9, 2.1}) speeds.push_back(speedOfSprings(spheres, seconds));
    std::ranges::sort(speeds);
    EXPECT_LT(speeds[speeds.size() / 2], std::sqrt(2 * earth * 0.5)) << "faster than from half a metre";
    EXPECT_LT(speeds.back(), std::sqrt(2 * earth * 1.5)) << "faster than from one and a half metres";
}

}  // namespace
}  // namespace spherule::physics
