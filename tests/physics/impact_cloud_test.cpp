#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "figures.h"
#include "frames.h"
#include "scene/random.h"
#include "support.h"

// Thousands of impacts in `balanced` keep momentum and angular momentum, and cost the same energy in any frame.
namespace spherule::physics {
namespace {

// A cloud of 1,000 spheres that turns, contracts and has random velocities and spins. No sphere of it moves by half a
// radius in a substep.
scene::Scene cloud(std::uint64_t seed, double restitution, double friction, bool equal) {
    constexpr double r = 0.1;
    scene::Scene scene = fineStepSpace(20);
    if (!equal)
        for (const double density : {500.0, 4000.0}) addMaterial(scene, {.density = density});
    setRestitution(scene, restitution);
    measure::setFriction(scene, friction);
    scene::Random random(seed);
    for (int k = 0; k < 1000; ++k) {
        const double size = equal ? r : random.uniform(0.8, 1) * r;
        const glm::dvec3 place(k % 10, k / 10 % 10, k / 100);
        const glm::dvec3 at = 2.5 * r * (place - 4.5) + 0.06 * r * normalVector(random);
        const glm::dvec3 flow = 10 * r * normalVector(random) - 2.0 * at + glm::cross(glm::dvec3(0, 0, 1), at);
        measure::addSphere(scene, at, size, flow, equal ? std::uint8_t{0} : static_cast<std::uint8_t>(k % 3)).spin =
            glm::vec3(5.0 * normalVector(random));
    }
    return scene;
}

constexpr std::uint64_t clouds = 8;

class ImpactsInACloud : public testing::TestWithParam<Frame> {};

TEST_P(ImpactsInACloud, KeepMomentumAndAngularMomentum) {
    for (const bool equal : {true, false}) {
        for (const double restitution : {0.5, 0.9, 1.0}) {
            const std::string gas = std::string(equal ? "Equal" : "Unequal") + std::to_string(restitution).substr(0, 3);
            double turned = 0;  // mean over the seeds
            for (std::uint64_t seed = 1; seed <= clouds; ++seed) {
                SCOPED_TRACE(testing::Message() << (equal ? "equal" : "unequal") << " spheres, restitution "
                                                << restitution << ", seed " << seed);
                const scene::Scene scene = inFrame(cloud(seed, restitution, 0.3, equal), GetParam(), 1);
                const auto simulation = simulate(scene);
                const sim::State start = simulation->snapshot();
                const Moments before = momentsOf(start);
                run(*simulation, GetParam().scale);
                const sim::State end = simulation->snapshot();
                const Moments now = momentsOf(end);
                EXPECT_EQ(simulation->substeps(), 1U);
                EXPECT_GT(simulation->statistics().impacts.count, 20);
                // The rounding of gravity's share of each substep is left out.
                const bool falls = simulation->scene().forces.gravity != glm::dvec3(0);
                const double gained =
                    falls ? 0 : glm::distance(now.momentum, before.momentum) / sim::momentumScale(start);
                EXPECT_LT(gained, 1e-6);
                turned += glm::distance(now.angular, before.angular) / before.angularScale / clouds;
                if (!falls) RecordProperty("momentum" + gas, figure(gained));
            }
            EXPECT_LT(turned, restitution < 0.9 ? 3e-4 : 5e-5) << gas;
            RecordProperty("angularMomentum" + gas, figure(turned));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(In, ImpactsInACloud, testing::Values(atRest(), moving(), rotated(), scaled(), falling()),
                         testing::PrintToStringParamName());

// Statistics of a cloud that cools, over seeds, do not depend on the frame.
TEST(ImpactsInAllFrames, CostTheSameEnergy) {
    constexpr int seeds = 6;
    struct Cooled {
        double mean = 0;
        double variance = 0;  // of the mean
    };
    const auto cooled = [](const Frame& frame) {
        std::array<double, seeds> left{};
        for (int seed = 0; seed < seeds; ++seed) {
            const scene::Scene scene = cloud(static_cast<std::uint64_t>(seed) + 10, 0.5, 0.3, true);
            const auto simulation = simulate(inFrame(scene, frame, 0.5));
            const double before = kineticEnergyIn(simulation->snapshot());
            run(*simulation, 0.5 * frame.scale);
            left.at(static_cast<std::size_t>(seed)) = kineticEnergyIn(simulation->snapshot()) / before;
        }
        Cooled result;
        for (const double share : left) result.mean += share / seeds;
        for (const double share : left)
            result.variance += (share - result.mean) * (share - result.mean) / (seeds * (seeds - 1));
        return result;
    };
    const Cooled still = cooled(atRest());
    EXPECT_LT(still.mean, 0.9) << "too few impacts";
    for (const Frame& frame : {moving(), rotated(), scaled(), falling()}) {
        const Cooled other = cooled(frame);
        EXPECT_NEAR(other.mean, still.mean, 3 * std::sqrt(other.variance + still.variance)) << frame.name;
        RecordProperty("energyLeft" + frame.name, figure(other.mean));
    }
    RecordProperty("energyLeft", figure(still.mean));
    RecordProperty("error", figure(std::sqrt(still.variance)));
}

// A scale of lengths and times by a power of two changes no digit: no constant of the law is a length or a time.
TEST(ImpactsInAllFrames, HaveTheSameDigitsAtAnotherScale) {
    scene::Scene scene = measure::lattice(400, 0.05, 5.1);
    measure::setFriction(scene, 0.3);
    scene.step = 1.0 / 480;
    scene.sleep.enabled = false;
    addMaterial(scene, {.density = 3000, .restitution = 0.9, .friction = 0.5, .rollingResistance = 0.05});
    for (std::size_t k = 0; k < scene.spheres.size(); k += 3) {
        scene.spheres[k].material = 1;
        scene.spheres[k].radius *= 0.7F;
    }
    const auto large = simulate(scene);
    const auto small = simulate(inFrame(scene, scaled()));
    run(*large, 1.5);
    run(*small, 1.5 * scaled().scale);
    const sim::State a = large->snapshot();
    const sim::State b = small->snapshot();
    std::uint32_t equal = 0;
    for (std::uint32_t id = 0; id < a.count(); ++id)
        if (positionOf(a, id) * scaled().scale == positionOf(b, id) && velocityOf(a, id) == velocityOf(b, id) &&
            spinOf(a, id) == spinOf(b, id) * scaled().scale)
            ++equal;
    EXPECT_EQ(equal, a.count());
    EXPECT_GT(large->statistics().contacts, 500U);
}

}  // namespace
}  // namespace spherule::physics
