#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "figures.h"
#include "frames.h"
#include "scene/random.h"
#include "support.h"

// Impacts of few spheres in `balanced` keep momentum, angular momentum and the energy that restitution leaves, for any
// phase of an impact within a substep, and in any frame.
namespace spherule::physics {
namespace {

constexpr int phases = 25;

class ImpactLaw : public testing::TestWithParam<Frame> {
  protected:
    static std::unique_ptr<sim::Simulation> after(const scene::Scene& scene, double seconds) {
        auto simulation = simulate(inFrame(scene, GetParam(), seconds));
        run(*simulation, seconds * GetParam().scale);
        return simulation;
    }
};

// Head-on pairs side by side. A pair begins to touch at its own phase of a substep.
TEST_P(ImpactLaw, RestitutionIsExactForAnyMassesAndPhases) {
    constexpr double speed = 2;
    const std::array<double, 5> masses{1, 1e3, 1e6, 1e-3, 1e-6};  // of the second sphere over the first
    Worst worst;
    for (const double restitution : {0.0, 0.25, 0.5, 0.9, 1.0}) {
        scene::Scene scene = fineStepSpace(8);
        scene.materials.clear();
        for (const double mass : masses)
            for (const double share : {1 / std::sqrt(mass), std::sqrt(mass)})
                addMaterial(scene, {.density = 1000 * share});
        setRestitution(scene, restitution);
        for (std::size_t kind = 0; kind < masses.size(); ++kind) {
            for (int k = 0; k < phases; ++k) {
                const double half = 0.05 + 0.5 * speed * scene.step * (3 + k / 24.7);
                const glm::dvec3 lane(0.05 * k - 0.6, 0.3 * k - 3.6, 0.3 * static_cast<double>(kind) - 0.6);
                const glm::dvec3 along(half, 0, 0);
                const auto first = static_cast<std::uint8_t>(2 * kind);
                measure::addSphere(scene, lane - along, 0.05, {0.5 * speed * (k % 3), 0, 0}, first);
                measure::addSphere(scene, lane + along, 0.05, {0.5 * speed * (k % 3) - speed, 0, 0}, first + 1);
            }
        }
        const sim::State end = after(scene, 0.05)->snapshot();
        for (std::uint32_t id = 0; id < end.count(); id += 2) {
            const glm::dvec3 parting = velocityOf(end, id + 1) - velocityOf(end, id);
            const double error = std::abs(GetParam().inside(parting).x - restitution * speed) / speed;
            worst.see(error, fmt::format("restitution {}, mass ratio {}, phase {}", restitution,
                                         masses.at(id / 2 / phases), id / 2 % phases));
        }
    }
    EXPECT_LT(worst.value, 1e-5 * support::errorOfDivisions()) << worst.of;
    RecordProperty("worst", figure(worst.value));
}

// The spheres touch at a quarter of a substep's motion, and have spin and friction.
TEST_P(ImpactLaw, ObliquePairsKeepAngularMomentum) {
    struct Kind {
        double mass, radius;  // of the second sphere over the first
    };
    constexpr double r = 0.5;
    constexpr double speed = 2;
    Worst turned;
    Worst misjudged;  // restitution
    Worst heated;
    for (const Kind kind : {Kind{1, 1}, Kind{30, 1}, Kind{8, 2}, Kind{1000, 4}}) {
        for (const double restitution : {0.0, 0.5, 0.9, 1.0}) {
            for (int k = 0; k < phases; ++k) {
                scene::Scene scene = fineStepSpace(20);
                addMaterial(scene, {.density = 1000 * kind.mass / std::pow(kind.radius, 3)});
                setRestitution(scene, restitution);
                measure::setFriction(scene, 0.3);
                const double reach = r * (1 + kind.radius);
                const glm::dvec3 normal(-std::sqrt(1 - 0.09), 0.3, 0);
                const glm::dvec3 gap(speed * (0.011 + 0.00031 * k), 0, 0);
                measure::addSphere(scene, reach * normal - gap, r, {speed, 0, 0.3}).spin = {0.3, -0.8, 2};
                measure::addSphere(scene, {}, r * kind.radius, {0, 0, 0.3}, 1);
                const scene::Scene framed = inFrame(scene, GetParam(), 0.1);
                const Moments before = momentsOf(sim::stateOf(framed));
                const auto simulation = simulate(framed);
                run(*simulation, 0.1 * GetParam().scale);
                const sim::State end = simulation->snapshot();
                const Moments now = momentsOf(end);
                const std::string which = fmt::format("masses 1:{}, radii 1:{}, restitution {}, phase {}", kind.mass,
                                                      kind.radius, restitution, k);
                turned.see(glm::distance(now.angular, before.angular) / before.angularScale, which);
                heated.see(now.kinetic / before.kinetic - 1, which);
                const glm::dvec3 apart = GetParam().inside(velocityOf(end, 0) - velocityOf(end, 1));
                misjudged.see(std::abs(glm::dot(apart, normal) / (speed * normal.x) + restitution), which);
            }
        }
    }
    EXPECT_LT(turned.value, 1e-5) << turned.of;
    EXPECT_LT(misjudged.value, 1e-5) << misjudged.of;
    EXPECT_LT(heated.value, 1e-5) << heated.of;
    RecordProperty("angularMomentum", figure(turned.value));
    RecordProperty("restitution", figure(misjudged.value));
}

// A chain of touching spheres is hit at one end. The chain has several places, directions and orders of ids.
TEST_P(ImpactLaw, TouchingCradlePassesTheImpactOn) {
    constexpr double r = 0.05;
    constexpr double speed = 1;
    constexpr std::uint32_t balls = 5;
    Worst energyError;
    Worst speedError;
    scene::Random random(1);
    for (int k = 0; k < 24; ++k) {
        glm::dvec3 along(0);
        along[k % 3] = k / 3 % 2 == 0 ? 1 : -1;
        std::vector<std::uint32_t> order(balls);  // order[id] = place in the chain
        std::iota(order.begin(), order.end(), 0);
        if (k / 6 % 2 == 1) std::ranges::reverse(order);
        scene::Scene scene = fineStepSpace(8);
        setRestitution(scene, 1);
        const glm::dvec3 first = k < 12 ? glm::dvec3(0) : 0.3 * normalVector(random);
        for (const std::uint32_t place : order) {
            const double at = 2 * r * (place - 2.0) - (place == 0 ? 0.0213 : 0);
            measure::addSphere(scene, first + at * along, r, place == 0 ? speed * along : glm::dvec3(0));
        }
        const auto simulation = simulate(inFrame(scene, GetParam(), 0.4));
        const double before = kineticEnergyIn(simulation->snapshot());
        run(*simulation, 0.4 * GetParam().scale);
        const sim::State end = simulation->snapshot();
        const auto last = static_cast<std::uint32_t>(std::ranges::find(order, balls - 1) - order.begin());
        const glm::dvec3 left = GetParam().inside(velocityOf(end, last) - GetParam().drift -
                                                  0.4 * simulation->scene().forces.gravity * GetParam().scale);
        speedError.see(std::abs(glm::dot(left, along) / speed - 1), fmt::format("case {}", k));
        energyError.see(std::abs(kineticEnergyIn(end) / before - 1), fmt::format("case {}", k));
    }
    EXPECT_LT(speedError.value, 1e-3) << speedError.of;
    EXPECT_LT(energyError.value, 1e-3) << energyError.of;
    RecordProperty("speed", figure(speedError.value));
    RecordProperty("energy", figure(energyError.value));
}

// A cluster of 30 touching spheres: a random tree, or a random part of a close packing. A sphere flies towards it.
scene::Scene cluster(std::uint64_t seed, double friction) {
    constexpr double r = 0.05;
    scene::Scene scene = fineStepSpace(8);
    setRestitution(scene, 1);
    measure::setFriction(scene, friction);
    scene::Random random(seed);
    const bool packed = seed % 2 == 0;
    const auto direction = [&]() -> glm::dvec3 {
        if (!packed) return glm::normalize(normalVector(random));
        glm::dvec3 step(random.uniform() < 0.5 ? -1 : 1, random.uniform() < 0.5 ? -1 : 1, 0);  // face-centred cubic
        std::swap(step[2], step[static_cast<int>(random.uniform(0, 3))]);
        return glm::normalize(step);
    };
    measure::addSphere(scene, {}, r);
    while (scene.spheres.size() < 30) {
        const auto host = static_cast<std::size_t>(random.uniform(0, static_cast<double>(scene.spheres.size())));
        const glm::dvec3 at = scene.spheres[host].position + 2 * r * direction();
        const auto blocks = [&at](const scene::Sphere& other) {
            return glm::distance(other.position, at) < 2 * r * (1 - 1e-9);
        };
        const bool taken = std::ranges::any_of(scene.spheres, blocks);
        if (!taken) measure::addSphere(scene, at, r);
    }
    const glm::dvec3 from = glm::normalize(normalVector(random));
    const glm::dvec3 aim = scene.spheres[static_cast<std::size_t>(random.uniform(0, 30))].position;
    double reach = 0;
    for (const scene::Sphere& sphere : scene.spheres) reach = std::max(reach, glm::distance(sphere.position, aim));
    measure::addSphere(scene, aim + (reach + 2.1 * r) * from, r, -2.0 * from);
    return scene;
}

TEST_P(ImpactLaw, TouchingClustersGainNoEnergy) {
    for (const double friction : {0.0, 0.3}) {
        Worst most;
        double least = 1e9;
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const auto simulation = simulate(inFrame(cluster(seed, friction), GetParam(), 0.5));
            const double before = kineticEnergyIn(simulation->snapshot());
            run(*simulation, 0.5 * GetParam().scale);
            const double share = kineticEnergyIn(simulation->snapshot()) / before;
            most.see(share, fmt::format("cluster {}", seed));
            least = std::min(least, share);
        }
        EXPECT_LT(most.value, 1.001) << most.of << ", friction " << friction;
        RecordProperty("mostEnergyAt" + figure(friction), figure(most.value));
        RecordProperty("leastEnergyAt" + figure(friction), figure(least));
    }
}

INSTANTIATE_TEST_SUITE_P(In, ImpactLaw, testing::Values(atRest(), moving(), rotated(), scaled(), falling()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace spherule::physics
