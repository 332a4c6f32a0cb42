// The cost of spheres that are poured onto a bed that sleeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "scene_support.h"
#include "support.h"

namespace spherule::physics {
namespace {

using scene::testing::parsed;

constexpr double begin = 2.5;  // s: when the emitter begins. The bed sleeps again before.
constexpr float depth = 1;     // m, at least: of the bed

// The box of box-50k with 1,000 spheres per second above the bed. `top`: of the bed (m).
scene::Scene emptyBox(float top, bool pouring) {
    const std::string emitter = fmt::format(
        R"("emitters": [{{"box": {{"min": [0.5, 0.5, {}], "max": [4.5, 4.5, {}]}}, "rate": 1000, "begin": {},
                         "radius": {{"constant": 0.05}}}}],)",
        top + 1.5F, top + 1.8F, begin);
    auto built = scene::build(parsed(fmt::format(
        R"({{{} "bounds": {{"min": [0, 0, 0], "max": [5, 5, 6], "open": ["Z_MAX"]}}}})", pouring ? emitter : "")));
    if (!built) throw std::invalid_argument(built.error().text());
    return std::move(*built);
}

// The spheres of the bed, from the highest to the lowest.
std::vector<glm::dvec3> settledBed() {
    scene::Scene box = named("box-50k");
    const auto simulation = simulate(box);
    while (sleepers(simulation->snapshot()) < simulation->count() && simulation->time() < 40) run(*simulation, 1);
    const sim::State state = simulation->snapshot();
    EXPECT_GE(sleepers(state), state.count() / 100 * 99);
    std::vector<glm::dvec3> bed;
    // Resting spheres overlap the walls by a little, which scenes must not.
    for (std::uint32_t k = 0; k < state.count(); ++k)
        bed.push_back(glm::clamp(positionOf(state, k) + box.bounds.centre(), glm::dvec3(0.0501), glm::dvec3(4.9499)));
    std::ranges::sort(bed, std::ranges::greater(), &glm::dvec3::z);
    return bed;
}

scene::Scene sceneWith(const std::vector<glm::dvec3>& bed, std::size_t count, bool pouring) {
    scene::Scene scene = emptyBox(static_cast<float>(bed.front().z), pouring);
    scene.bounds.min.z = bed[count - 1].z - 0.0501;
    for (std::size_t k = 0; k < count; ++k) measure::addSphere(scene, bed[k], 0.05);
    return scene;
}

constexpr double turn = 0.05;  // s simulated: it includes rebuilds of all

// Returns the seconds for a turn.
double secondsOf(sim::Simulation& simulation) {
    const auto start = std::chrono::steady_clock::now();
    run(simulation, turn);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

// A step costs at most 1.5 times the sum of two others. One is a step of the sleeping bed. In the other, the same
// spheres fall on as many awake ones, with sleep off. The ratio was 1.22 to 1.35 on an EPYC with two processors. The
// three take turns, so that a busy machine slows all of them.
TEST(PouringCost, IsThatOfTheSpheresWhichAreAwake) {
    const std::vector<glm::dvec3> bed = settledBed();
    ASSERT_GT(bed.front().z, depth);
    auto pouring = simulate(sceneWith(bed, bed.size(), true));
    auto asleep = simulate(sceneWith(bed, bed.size(), false));
    run(*pouring, begin + 1);
    run(*asleep, begin + 1);
    const sim::Statistics statistics = pouring->statistics();
    const std::size_t awake = statistics.spheres - statistics.sleeping;
    ASSERT_GT(awake, bed.size() / 10);
    ASSERT_LT(awake, bed.size() / 2);
    ASSERT_GE(asleep->statistics().sleeping, bed.size() / 100 * 99);
    scene::Scene top = sceneWith(bed, awake, true);
    top.sleep.enabled = false;
    auto awakeAlone = simulate(top);
    run(*awakeAlone, begin + 1);
    std::vector<double> ratios;
    std::vector<double> steps[3];
    for (int round = 0; round < 41; ++round) {
        const double whole = secondsOf(*pouring);
        const double sleeping = secondsOf(*asleep);
        const double moving = secondsOf(*awakeAlone);
        ratios.push_back(whole / (sleeping + moving));
        steps[0].push_back(whole);
        steps[1].push_back(sleeping);
        steps[2].push_back(moving);
    }
    std::cout << fmt::format("{} awake; ms per turn: {:.2f}, bed asleep {:.2f}, as many awake {:.2f}; ratio {:.3f}\n",
                             awake, 1e3 * median(steps[0]), 1e3 * median(steps[1]), 1e3 * median(steps[2]),
                             median(ratios));
    EXPECT_LT(median(ratios), 1.5);
    EXPECT_EQ(pouring->statistics().nonFinite, 0U);
}

}  // namespace
}  // namespace spherule::physics
