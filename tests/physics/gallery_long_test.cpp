// Every scene of the program runs for a minute on the CPU, and gives the same bits on all devices. Large scenes are
// reduced (gallery_scenes.h).
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "diagnostics/energy_watch.h"
#include "gallery_scenes.h"
#include "support.h"

namespace spherule::physics {
namespace {

class GalleryMinute : public testing::TestWithParam<std::string> {};

// Energy that something gave is no rise: emitters and sinks, obstacles and media that move, and borders of fields.
bool keepsItsEnergy(const scene::Scene& scene) {
    return scene.emitters.empty() && scene.sinks.empty() && !scene::anyMoves(scene.obstacles) &&
           !scene.forces.addEnergy();
}

diagnostics::EnergyWatch::Reading readingOf(const sim::Statistics& now) {
    constexpr double squeezed = 0.05;  // of the radius: contacts store energy
    return {.step = now.step,
            .kinetic = now.kineticEnergy + now.rotationalEnergy,
            .potential = now.potentialEnergy,
            .fields = now.fieldEnergy,
            .elastic = now.elasticEnergy,
            .given = now.pushWork - now.unboundedEnergy,
            .soft = now.deepest() > squeezed};
}

// Returns the number of spheres beyond a face that is a wall. Others may leave through open faces, and fall for ever.
std::uint32_t beyondWalls(const sim::Simulation& simulation, const sim::State& state) {
    const scene::Bounds& bounds = simulation.scene().bounds;
    std::uint32_t beyond = 0;
    for (std::uint32_t k = 0; k < state.count(); ++k) {
        const glm::dvec3 x = sim::positionOf(state, k) + bounds.centre();
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            const auto low = static_cast<std::size_t>(2 * axis);
            inside = inside && (bounds.open[low] || x[axis] >= bounds.min[axis]) &&
                     (bounds.open[low + 1] || x[axis] <= bounds.max[axis]);
        }
        beyond += inside ? 0 : 1;
    }
    return beyond;
}

TEST_P(GalleryMinute, IsFiniteAndKeepsItsSpheres) {
    const scene::Scene scene = reduced(named(GetParam()), 50'000);
    const auto device = compute::openDevice("cpu").value();
    const auto simulation = simulate(scene, *device);
    diagnostics::EnergyWatch watch;
    for (int second = 1; second <= 60; ++second) {
        run(*simulation, 1);
        const sim::Statistics now = simulation->statistics();
        ASSERT_EQ(now.nonFinite, 0U) << "after " << second << " s";
        EXPECT_EQ(now.born, now.spheres + now.removed) << "after " << second << " s";
        if (scene.sinks.empty()) {
            EXPECT_EQ(now.removed, 0U);
        }
        if (keepsItsEnergy(scene)) {
            const auto alarm = watch.check(readingOf(now));
            EXPECT_FALSE(alarm) << *alarm;
        }
    }
    const sim::State state = simulation->snapshot();
    EXPECT_TRUE(allFinite(state));
    EXPECT_EQ(beyondWalls(*simulation, state), 0U);
}

class GalleryBits : public testing::TestWithParam<std::string> {};

// After 120 steps, in which emitters and motions have begun, with at most 2,000 spheres that are not fixed.
TEST_P(GalleryBits, OfVariantsAreTheSameOnAllDevices) {
    const scene::Scene scene = reduced(named(GetParam()), 2'000);
    std::optional<std::uint64_t> expected;
    for (const char* const choice : {"cpu:1", "cpu:2", "software"}) {
        const auto device = compute::openDevice(choice).value();
        const auto simulation = simulate(scene, *device);
        run(*simulation, 120 * scene.step);
        const std::uint64_t hash = sim::hashOf(simulation->snapshot());
        EXPECT_EQ(hash, expected.value_or(hash)) << choice;
        expected = hash;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, GalleryBits, testing::ValuesIn(galleryScenes()), testNameOf);

INSTANTIATE_TEST_SUITE_P(Of, GalleryMinute, testing::ValuesIn(galleryScenes()), testNameOf);

}  // namespace
}  // namespace spherule::physics
