#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "figures.h"
#include "frames.h"
#include "scene/random.h"
#include "support.h"

// Impacts in `balanced` at walls, at a heavy sphere and in a dense gas keep the energy that restitution leaves.
namespace spherule::physics {
namespace {

constexpr int phases = 25;

class ImpactAtWalls : public testing::TestWithParam<Frame> {};

// Elastic spheres in a closed box, on a lattice at the beginning. A density is the share of the volume.
TEST_P(ImpactAtWalls, ElasticGasKeepsItsEnergy) {
    constexpr int side = 7;
    constexpr double r = 0.05;
    for (const double density : {0.1, 0.2, 0.3, 0.4}) {
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            SCOPED_TRACE(testing::Message() << "density " << density << ", seed " << seed);
            const double pitch = r * std::cbrt(4.0 / 3 * std::numbers::pi / density);
            scene::Scene scene = fineStepBox(side * pitch);
            scene.forces.gravity = {};
            setRestitution(scene, 1);
            scene::Random random(seed);
            for (int k = 0; k < side * side * side; ++k) {
                const glm::dvec3 place(k % side, k / side % side, k / side / side);
                measure::addSphere(scene, pitch * (place - 0.5 * (side - 1)), r, normalVector(random));
            }
            const auto simulation = simulate(inFrame(scene, GetParam()));
            const double before = sim::kineticEnergyOf(simulation->snapshot());
            run(*simulation, 3 * GetParam().scale);
            const double share = sim::kineticEnergyOf(simulation->snapshot()) / before;
            EXPECT_NEAR(share, 1, 0.01);
            EXPECT_GT(simulation->statistics().impacts.count, 100);
            RecordProperty("energyAt" + std::to_string(density).substr(0, 3) + "Seed" + std::to_string(seed),
                           figure(share));
        }
    }
}

// Returns the worst relative error of the first five apexes of the last sphere. `contact`: its height during impacts.
double apexError(sim::Simulation& simulation, const Frame& frame, double contact, double drop) {
    constexpr double restitution = 0.8;
    const std::uint32_t id = simulation.count() - 1;
    double expected = drop;
    double worst = 0;
    int apexes = 0;
    bool rising = false;
    for (int step = 0; step < 480 * 4 && apexes < 5; ++step) {
        run(simulation, simulation.scene().step);
        const sim::State state = simulation.snapshot();
        const double speed = frame.inside(velocityOf(state, id)).z;
        if (rising && speed <= 0) {
            expected *= restitution * restitution;
            const double height = frame.inside(positionOf(state, id)).z / frame.scale;
            worst = std::max(worst, std::abs((height - contact + speed * speed / (2 * earth)) / expected - 1));
            ++apexes;
        }
        rising = speed > 0;
    }
    return apexes == 5 ? worst : 1;
}

TEST_P(ImpactAtWalls, ApexesOnTheFloorAreExact) {
    Worst worst;
    for (int k = 0; k < phases; ++k) {
        scene::Scene scene = fineStepBox(4);
        setRestitution(scene, 0.8);
        const double drop = 0.9 + 0.011 * k;
        measure::addSphere(scene, {0, 0, -1.95 + drop}, 0.05);
        worst.see(apexError(*simulate(inFrame(scene, GetParam())), GetParam(), -1.95, drop),
                  fmt::format("phase {}", k));
    }
    EXPECT_LT(worst.value, 1e-4) << worst.of;
    RecordProperty("worst", figure(worst.value));
}

INSTANTIATE_TEST_SUITE_P(In, ImpactAtWalls, testing::Values(atRest(), rotated(), scaled()),
                         testing::PrintToStringParamName());

// The lower sphere has 10^8 times the mass of the upper one, and rests on the floor. No rotated frame: an impact off
// the middle by a rounding grows at each impact.
TEST(ImpactAtHeavySphere, ApexesAreExact) {
    for (const Frame& frame : {atRest(), scaled()}) {
        Worst worst;
        for (int k = 0; k < phases; ++k) {
            scene::Scene scene = fineStepBox(4);
            addMaterial(scene, {.density = 1e11});
            for (scene::Material& material : scene.materials)
                material.friction = 0.3;  // without friction, the floor is soft
            setRestitution(scene, 0.8);
            const double drop = 0.9 + 0.011 * k;
            measure::addSphere(scene, {0, 0, -1.95}, 0.05, {}, 1);
            measure::addSphere(scene, {0, 0, -1.85 + drop}, 0.05);
            worst.see(apexError(*simulate(inFrame(scene, frame)), frame, -1.85, drop), fmt::format("phase {}", k));
        }
        EXPECT_LT(worst.value, 1e-4) << frame.name << ", " << worst.of;
        RecordProperty("worst" + frame.name, figure(worst.value));
    }
}

// The lower of two spheres rests on the floor and carries the upper one. A push gives it a downward speed. Its contact
// with the floor holds the impulse of `load` times its own weight. Returns the rebound over the restitution times the
// speed, in a substep. `share`: the speed over five times the change of velocity by the load.
double reboundUnderLoad(double load, double share) {
    constexpr double r = 0.05;
    constexpr double restitution = 0.8;
    scene::Scene scene = fineStepBox(4);
    scene.materials[0].friction = 0.3;  // without friction, contacts are soft
    measure::addSphere(scene, {0, 0, -2 + r}, r);
    if (load > 1) {
        const std::uint8_t top = addMaterial(scene, {.density = 1000 * (load - 1), .friction = 0.3});
        measure::addSphere(scene, {0, 0, -2 + 3 * r}, r, {}, top);
    }
    setRestitution(scene, restitution);
    const auto simulation = simulate(scene);
    run(*simulation, 2);
    const double mass = 1000 * 4.0 / 3 * std::numbers::pi * r * r * r;
    const double speed = share * 5 * load * earth / 480;
    EXPECT_TRUE(simulation->apply(sim::Push{.target = 0U, .impulse = {0, 0, -mass * speed}}));
    EXPECT_TRUE(simulation->advance());
    return velocityOf(simulation->snapshot(), 0).z / (restitution * speed);
}

// Slower approaches of a contact under load are the unfinished balance of a pile: they do not bounce.
TEST(ImpactUnderLoad, BouncesAboveFiveTimesTheLoad) {
    for (const double load : {1.0, 10.0, 100.0})
        for (const double share : {0.2, 0.5, 0.9, 0.99, 1.01, 1.1, 1.5, 2.0, 5.0, 20.0}) {
            const double rebound = reboundUnderLoad(load, share);
            EXPECT_NEAR(rebound, share < 1 ? 0 : 1, 1e-4) << "load " << load << ", share " << share;
            RecordProperty(fmt::format("load{}Share{}", load, share), figure(rebound));
        }
}

}  // namespace
}  // namespace spherule::physics
