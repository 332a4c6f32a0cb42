// Scenes that come with the program do what their descriptions say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support.h"

namespace spherule::physics {
namespace {

std::vector<glm::dvec3> placesOf(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    std::vector<glm::dvec3> places;
    for (std::uint32_t k = 0; k < state.count(); ++k)
        places.push_back(sim::positionOf(state, k) + simulation.scene().bounds.centre());
    return places;
}

class Galton : public testing::TestWithParam<unsigned> {};  // by seed

// The spheres turn left or right at each row of pegs, alike often.
TEST_P(Galton, BallsSpreadEvenlyAroundTheMiddle) {
    const auto simulation = simulate(named("galton", {.seed = GetParam()}));
    run(*simulation, 15);
    double sum = 0;
    double squares = 0;
    unsigned inMiddle = 0;  // a third of the width
    unsigned below = 0;     // the pegs
    const auto places = placesOf(*simulation);
    for (const glm::dvec3& x : places) {
        sum += x.x;
        squares += x.x * x.x;
        if (std::abs(x.x) < 0.63) ++inMiddle;
        if (x.z < 2.2) ++below;
    }
    const auto count = static_cast<double>(places.size());
    const double deviation = std::sqrt(squares / count);
    RecordProperty("mean", std::to_string(sum / count));
    RecordProperty("deviation", std::to_string(deviation));
    EXPECT_EQ(below, places.size());
    EXPECT_LT(std::abs(sum / count), 3 * deviation / std::sqrt(count));
    EXPECT_GT(inMiddle, places.size() / 2);
    EXPECT_GT(deviation, 0.5);
    EXPECT_LT(deviation, 0.9);
}

INSTANTIATE_TEST_SUITE_P(Of, Galton, testing::Values(1U, 2U, 3U));

// Funnel and pipe are shells of no thickness, below the weight of all spheres.
TEST(Hopper, RunsOutThroughThePipeAlone) {
    const auto simulation = simulate(named("hopper"));
    std::vector<double> left;  // spheres in it, once a second
    for (int second = 1; second <= 5; ++second) {
        run(*simulation, 1);
        unsigned inside = 0;
        for (const glm::dvec3& x : placesOf(*simulation)) {
            if (x.z < 1.6) continue;
            ++inside;
            const double wall = x.z > 2.5 ? 0.95 : 0.17 + (x.z - 1.6) * (0.95 - 0.17) / 0.9;
            EXPECT_LT(std::hypot(x.x, x.y), wall) << "at " << x.z << " m after " << second << " s";
        }
        left.push_back(inside);
    }
    // The outflow does not depend on how high they stand.
    const double rate = (left[1] - left[4]) / 3;  // 1/s
    for (std::size_t second = 2; second < 5; ++second) EXPECT_NEAR(left[second - 1] - left[second], rate, 0.15 * rate);
    EXPECT_GT(rate, 150);
    RecordProperty("rate", std::to_string(rate));
}

}  // namespace
}  // namespace spherule::physics
