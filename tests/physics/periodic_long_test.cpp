// Gases in periodic bounds over several seeds, with enough impacts for a mean within half a percent.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>

#include "periodic_gas.h"
#include "scene/quality.h"

namespace spherule::physics {
namespace {

class LongPeriodicGas : public testing::TestWithParam<std::tuple<scene::Model, double>> {};

TEST_P(LongPeriodicGas, HasThePressureOfHardSpheres) {
    const auto [model, fraction] = GetParam();
    constexpr std::uint64_t seeds = 3;
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const double impacts = model == scene::Model::Accurate ? 20'000 : 60'000;
        mean += pressureOf(model, fraction, 1372, seed, impacts).compressibility / carnahanStarling(fraction) / seeds;
    }
    EXPECT_NEAR(mean, 1, 0.01);
    RecordProperty("ratio", std::to_string(mean));
}

INSTANTIATE_TEST_SUITE_P(Of, LongPeriodicGas,
                         testing::Combine(testing::Values(scene::Model::Balanced, scene::Model::Accurate),
                                          testing::Values(0.2, 0.4)),
                         [](const auto& parameter) {
                             return std::string(scene::nameOf(std::get<0>(parameter.param))) +
                                    std::to_string(std::lround(100 * std::get<1>(parameter.param))) + "Percent";
                         });

TEST(LongPeriodic, TheFluxThroughASeamIsThatOfAGas) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced}) {
        const GasFlux found = fluxOf(model, 500, 2, 100'000);
        EXPECT_NEAR(found.measured / found.expected, 1, 0.01) << scene::nameOf(model);
    }
}

}  // namespace
}  // namespace spherule::physics
