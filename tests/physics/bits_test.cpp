// Every scene that comes with the program, on the CPU with different numbers of threads and on Mesa's software
// renderer: the same bits. SPHERULE_BITS_SECONDS says for how long; without it, 2 s, and one step of a scene above
// 100,000 spheres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "support.h"

namespace spherule::physics {
namespace {

constexpr std::uint32_t large = 100'000;

class Bits : public testing::TestWithParam<std::string> {};

double durationOf(const scene::Scene& scene) {
    const char* const asked = std::getenv("SPHERULE_BITS_SECONDS");
    if (asked != nullptr) return std::stod(asked);
    return scene.spheres.size() > large ? scene.step : 2.0;
}

std::uint64_t hashOn(const std::string& choice, const std::string& name) {
    const auto device = compute::openDevice(choice).value();
    auto simulation = sim::Simulation::create(*device, named(name)).value();
    run(*simulation, durationOf(simulation->scene()));
    return sim::hashOf(simulation->snapshot());
}

TEST_P(Bits, AreTheSameOnAllDevices) {
    const std::uint64_t expected = hashOn("software", GetParam());
    for (const char* const choice : {"cpu:1", "cpu:2", "cpu:3", "cpu:8"})
        EXPECT_EQ(hashOn(choice, GetParam()), expected) << choice;
}

INSTANTIATE_TEST_SUITE_P(Of, Bits, testing::ValuesIn(scene::names()), [](const auto& parameter) {
    std::string name = parameter.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

}  // namespace
}  // namespace spherule::physics
