// Every scene of the program runs for a minute on the CPU, and gives the same bits on all devices. Large scenes are
// reduced (gallery_scenes.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "diagnostics/energy_watch.h"
#include "gallery_scenes.h"
#include "support.h"

namespace spherule::physics {
namespace {

class GalleryMinute : public testing::TestWithParam<std::string> {};

// Watches the energy as the server does (host/simulation_producer.cpp): readings before a step in which something gave
// or took energy count no more. Births and sinks do so only when they happen.
class Watch {
  public:
    void step(sim::Simulation& simulation) {
        run(simulation, simulation.scene().step);
        const std::uint64_t population = simulation.population().version();
        const scene::Scene& scene = simulation.scene();
        const bool given = population != std::exchange(population_, population) || simulation.pulling() ||
                           scene::anyMoves(scene.obstacles) || scene.forces.addEnergy();
        if (given || simulation.substeps() != std::exchange(substeps_, simulation.substeps()))
            energy_.invalidateBaseline();
    }
    void check(sim::Simulation& simulation, const sim::Statistics& now) {
        compared_ += energy_.fresh() ? 0 : 1;
        const auto alarm = energy_.check(readingOf(simulation, now));
        EXPECT_FALSE(alarm) << *alarm;
    }
    // Returns the number of readings that were compared with earlier ones.
    [[nodiscard]] unsigned compared() const { return compared_; }

  private:
    static diagnostics::EnergyWatch::Reading readingOf(const sim::Simulation& simulation, const sim::Statistics& now);

    diagnostics::EnergyWatch energy_;
    std::uint64_t population_ = 0;
    std::uint32_t substeps_ = 0;
    unsigned compared_ = 0;
};

diagnostics::EnergyWatch::Reading Watch::readingOf(const sim::Simulation& simulation, const sim::Statistics& now) {
    constexpr double squeezed = 0.05;  // of the radius: contacts store energy
    return {.step = now.step,
            .kinetic = now.kineticEnergy + now.rotationalEnergy,
            .potential = now.potentialEnergy,
            .fields = now.fieldEnergy,
            .elastic = now.elasticEnergy,
            .given = now.pushWork - now.unboundedEnergy,
            .soft = simulation.scene().quality.model == scene::Model::Balanced ? now.deepest() > squeezed
                                                                               : simulation.counters().unlisted > 0};
}

TEST_P(GalleryMinute, IsFiniteAndKeepsItsSpheres) {
    const scene::Scene scene = reduced(named(GetParam()), 50'000);
    const auto device = compute::openDevice("cpu").value();
    const auto simulation = simulate(scene, *device);
    // Births and sinks leave little time between them.
    const bool flows = !scene.emitters.empty() || !scene.sinks.empty();
    const auto steps = flows ? 1 : std::lround(1 / scene.step);
    Watch watch;
    sim::Statistics now;
    do {
        for (long k = 0; k < steps; ++k) watch.step(*simulation);
        now = simulation->statistics();
        ASSERT_EQ(now.nonFinite, 0U) << "after " << now.time << " s";
        EXPECT_EQ(now.born, now.spheres + now.removed) << "after " << now.time << " s";
        if (scene.sinks.empty()) {
            EXPECT_EQ(now.removed, 0U);
        }
        watch.check(*simulation, now);
    } while (now.time < 59.99);
    RecordProperty("compared", std::to_string(watch.compared()));
    if (!scene::anyMoves(scene.obstacles) && !scene.forces.addEnergy()) {
        EXPECT_GT(watch.compared(), 50U);
    }
    EXPECT_TRUE(allFinite(simulation->snapshot()));
    // None has left, except where all faces are open: there, spheres part and fly away, as the texts of the scenes say.
    if (!std::ranges::all_of(scene.bounds.open, std::identity())) {
        EXPECT_EQ(now.outside, 0U);
    }
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
