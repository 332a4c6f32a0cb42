// Contact sums: virial stress, dissipated energy, and collisions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "event_driven.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

using measure::addSphere;
using measure::setFriction;
using scene::Model;

double volumeOf(const scene::Scene& scene) {
    const glm::dvec3 size = scene.bounds.max - scene.bounds.min;
    return size.x * size.y * size.z;
}

double trace(const sim::Tensor& tensor) {
    return tensor[0] + tensor[1] + tensor[2];
}

// All mechanical energy (J).
double energyOf(const sim::Statistics& now) {
    return now.kineticEnergy + now.rotationalEnergy + now.potentialEnergy + now.elasticEnergy;
}

class ContactSums : public testing::TestWithParam<Model> {};

// An impact of hard spheres has the virial 2 r J n n, and loses a share 1 - e^2 of the energy along the normal.
TEST_P(ContactSums, OfAnImpactAreThoseOfHardSpheres) {
    scene::Random random(3);
    for (const double e : {1.0, 0.6}) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
        scene::Scene scene = fineStepSpace(4);
        setRestitution(scene, e);
        scene.quality.overlap = 0.004;  // soft spheres are nearer to each other
        const double r = 0.05;
        const double speed = 1.5;
        // They meet within a substep. Where it ends, an impact may be counted in the next one, or in both.
        addSphere(scene, -0.1007 * n, r, speed * n);
        addSphere(scene, 0.1007 * n, r, -speed * n);
        measureContacts(scene, GetParam());
        auto simulation = simulate(scene);
        EXPECT_FALSE(simulation->statistics().contactStress) << "no time has passed";
        run(*simulation, 0.1);
        const sim::Statistics now = simulation->statistics();
        ASSERT_TRUE(now.contactSums && now.contactStress);
        const double mass = massOf(simulation->snapshot(), 0);
        const double virial = 2 * r * (1 + e) * mass * speed;
        const std::array<double, 6> shape{n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
        for (std::size_t k = 0; k < 6; ++k) {
            EXPECT_NEAR(now.contactSums->virial[k], virial * shape[k], 3e-3 * virial);
            EXPECT_NEAR((*now.contactStress)[k], now.contactSums->virial[k] / (0.1 * volumeOf(scene)), 1e-9);
        }
        EXPECT_EQ(now.contactSums->collisions, 1);
        EXPECT_NEAR(now.contactSums->seconds, 0.1, 1e-9);
        const double lost = (1 - e * e) * mass * speed * speed;
        EXPECT_NEAR(now.contactSums->dissipated, lost, 5e-3 * mass * speed * speed);
        EXPECT_NEAR(trace(now.kineticStress) * volumeOf(scene), 2 * now.kineticEnergy, 1e-5 * now.kineticEnergy);
        EXPECT_NEAR(now.kineticStress[3] * volumeOf(scene), 2 * now.kineticEnergy * n.x * n.y,
                    1e-3 * now.kineticEnergy);
    }
}

// The contact of a sphere at rest on another one bears its weight all the time.
TEST_P(ContactSums, OfARestingSphereHaveItsWeight) {
    scene::Scene scene = fineStepSpace(2);
    scene.forces.gravity = {0, 0, -earth};
    setRestitution(scene, 0);
    setFriction(scene, 0.5);
    addSphere(scene, {0, 0, 0}, 0.1).fixed = true;
    addSphere(scene, {0, 0, 0.15}, 0.05);
    measureContacts(scene, GetParam());
    auto simulation = simulate(scene);
    run(*simulation, 0.1);
    const sim::ContactSums before = *simulation->statistics().contactSums;
    constexpr double seconds = 0.05;
    run(*simulation, seconds);
    const sim::ContactSums sums = simulation->statistics().contactSums->since(before);
    const double force = massOf(simulation->snapshot(), 1) * earth;
    EXPECT_NEAR(sums.virial[2], 0.15 * force * seconds, 0.01 * 0.15 * force * seconds);
    for (const std::size_t k : {0U, 1U, 3U, 4U, 5U}) EXPECT_NEAR(sums.virial[k], 0, 1e-3 * 0.15 * force * seconds);
    EXPECT_NEAR(sums.dissipated, 0, 1e-3 * force * 0.05);
}

// Spheres without gravity lose energy only in contacts.
TEST_P(ContactSums, OfRandomImpactsDissipateWhatTheSpheresLose) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        scene::Scene scene = fineStepSpace(1);
        scene.bounds.open.fill(false);
        setRestitution(scene, 0.7);
        setFriction(scene, 0.3);
        scene::Random random(seed);
        for (int k = 0; k < 125; ++k)
            addSphere(scene, 0.18 * (glm::dvec3(k % 5, k / 5 % 5, k / 25) - 2.0), random.uniform(0.03, 0.07),
                      {random.normal(), random.normal(), random.normal()});
        measureContacts(scene, GetParam());
        auto simulation = simulate(scene);
        const sim::Statistics before = simulation->statistics();
        run(*simulation, GetParam() == Model::Accurate ? 0.3 : 1);
        const sim::Statistics after = simulation->statistics();
        const double lost = energyOf(before) - energyOf(after);
        EXPECT_GT(lost, 0.2 * energyOf(before));
        EXPECT_NEAR(after.contactSums->dissipated, lost, 1e-4 * lost) << seed;
    }
}

// A heap that falls into a box and settles. In `balanced`, impulses of a substep act along with gravity, and overlaps
// are removed by moving spheres up: the sum is by so much larger.
TEST_P(ContactSums, OfASettlingBedDissipateWhatItLoses) {
    scene::Scene scene = fineStepBox(0.6);
    scene.bounds.open[scene::ZMax] = true;
    scene.step = 1.0 / 60;
    setRestitution(scene, 0.5);
    setFriction(scene, 0.4);
    scene::Random random(5);
    for (int k = 0; k < 250; ++k)
        addSphere(scene,
                  0.11 * glm::dvec3(k % 5 - 2, k / 5 % 5 - 2, k / 25 - 2) +
                      glm::dvec3(random.uniform(-0.004, 0.004), random.uniform(-0.004, 0.004), 0),
                  0.05);
    measureContacts(scene, GetParam());
    auto simulation = simulate(scene);
    const sim::Statistics before = simulation->statistics();
    run(*simulation, GetParam() == Model::Accurate ? 1 : 2);
    const sim::Statistics after = simulation->statistics();
    const double lost = energyOf(before) - energyOf(after);
    EXPECT_GT(lost, 0.3 * before.potentialEnergy);
    EXPECT_NEAR(after.contactSums->dissipated, lost, (GetParam() == Model::Balanced ? 0.04 : 1e-3) * lost);
}

// They do not depend on commands in between.
TEST_P(ContactSums, GoOnThroughCommands) {
    scene::Scene scene = fineStepBox(1);
    setRestitution(scene, 0.5);
    scene::Random random(6);
    for (int k = 0; k < 64; ++k)
        addSphere(scene, 0.2 * (glm::dvec3(k % 4, k / 4 % 4, k / 16) - 1.5), 0.06, {random.normal(), 0, 0});
    measureContacts(scene, GetParam());
    auto simulation = simulate(scene);
    run(*simulation, 0.3);
    const sim::ContactSums first = *simulation->statistics().contactSums;
    EXPECT_GT(first.collisions, 0);
    ASSERT_TRUE(simulation->apply(sim::Set{.friction = 0.2}));  // makes other arrays
    const sim::ContactSums second = *simulation->statistics().contactSums;
    EXPECT_EQ(second.collisions, first.collisions);
    EXPECT_EQ(second.virial, first.virial);
    EXPECT_NEAR(second.dissipated, first.dissipated, 1e-9);
    const double before = energyOf(simulation->statistics());
    ASSERT_TRUE(simulation->apply(sim::Set{.gravity = glm::dvec3(0, 0, -5)}));
    EXPECT_NEAR(simulation->statistics().contactSums->dissipated, first.dissipated, 1e-9);
    EXPECT_NE(energyOf(simulation->statistics()), before);
    ASSERT_TRUE(simulation->apply(sim::Reset{}));
    EXPECT_EQ(simulation->statistics().contactSums->collisions, 0);
    EXPECT_EQ(simulation->statistics().contactSums->dissipated, 0);
}

// Measuring changes no state, and a scene that does not ask for it has nothing of it.
TEST_P(ContactSums, ChangeNoState) {
    const auto hashOf = [](bool sums) {
        scene::Scene scene = sleepyBox(0.8);
        setFriction(scene, 0.3);
        scene::Random random(7);
        for (int k = 0; k < 216; ++k)
            addSphere(scene, 0.12 * (glm::dvec3(k % 6, k / 6 % 6, k / 36) - 2.5), random.uniform(0.03, 0.06));
        measureContacts(scene, GetParam());
        scene.contactSums = sums;
        auto simulation = simulate(scene);
        run(*simulation, GetParam() == Model::Accurate ? 0.1 : 1);
        EXPECT_EQ(simulation->statistics().contactSums.has_value(), sums);
        EXPECT_EQ(simulation->plan().has(sim::Array::StartVelocity), sums);
        return sim::hashOf(simulation->snapshot());
    };
    EXPECT_EQ(hashOf(true), hashOf(false));
}

INSTANTIATE_TEST_SUITE_P(Of, ContactSums, testing::Values(Model::Fast, Model::Balanced, Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

struct Gas {
    scene::Scene scene;
    double side = 0;
    double radius = 0;
};

// An elastic gas of equal spheres on a lattice in a closed box, with random velocities. `share`: of the volume.
Gas gas(std::uint32_t perSide, double share, Model model, std::uint64_t seed) {
    constexpr double radius = 0.05;
    const double count = std::pow(perSide, 3);
    const double side = std::cbrt(count * 4 / 3 * std::numbers::pi / share) * radius;
    scene::Scene scene = measure::openSpace(side);
    scene.bounds.open.fill(false);
    setRestitution(scene, 1);
    scene::Random random(seed);
    const double pitch = (side - 2 * radius) / (perSide - 1);
    for (std::uint32_t k = 0; k < perSide * perSide * perSide; ++k)
        addSphere(scene,
                  radius - side / 2 + pitch * glm::dvec3(k % perSide, k / perSide % perSide, k / (perSide * perSide)),
                  radius, {random.normal(), random.normal(), random.normal()});
    measureContacts(scene, model);
    return {.scene = std::move(scene), .side = side, .radius = radius};
}

class GasSums : public testing::TestWithParam<Model> {};

// The reference has the same spheres at the beginning. Courses part soon, so only means are compared.
TEST_P(GasSums, AreThoseOfExactImpacts) {
    for (const double share : {0.1, 0.25}) {
        const Gas one = gas(10, share, GetParam(), 8);
        std::vector<reference::HardSphere> spheres;
        for (const scene::Sphere& sphere : one.scene.spheres)
            spheres.push_back({sphere.position, glm::dvec3(sphere.velocity)});
        reference::HardSphereGas exact(spheres, one.side, one.radius, 1, 1);
        const double settling = 0.3;
        const double seconds = 2;
        exact.run(settling);
        const auto impactsBefore = static_cast<double>(exact.pairImpacts());
        const double impulseBefore = exact.pairImpulse();
        exact.run(seconds);
        auto simulation = simulate(one.scene);
        run(*simulation, settling);
        const sim::ContactSums before = *simulation->statistics().contactSums;
        run(*simulation, seconds);
        const sim::ContactSums sums = simulation->statistics().contactSums->since(before);
        const double impacts = static_cast<double>(exact.pairImpacts()) - impactsBefore;
        const double mass = massOf(simulation->snapshot(), 0);
        const double virial = 2 * one.radius * mass * (exact.pairImpulse() - impulseBefore);
        EXPECT_GT(impacts, 3000);
        EXPECT_NEAR(sums.collisions / impacts, 1, 0.03) << share;
        EXPECT_NEAR(trace(sums.virial) / virial, 1, 0.03) << share;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, GasSums, testing::Values(Model::Fast, Model::Balanced),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

// The pressure p on the walls follows from the virial theorem: 3 p V = 2 E + W, with the volume V for the centres.
// The spheres at the walls lower the density in the middle. To the first order of the density n, each area has pi n^2
// d^4 / 8 spheres more than the middle.
TEST(GasPressure, IsThatOfCarnahanAndStarlingAndOfTheWalls) {
    for (const double share : {0.05, 0.15}) {
        const Gas one = gas(18, share, Model::Balanced, 9);
        auto simulation = simulate(one.scene);
        run(*simulation, 0.3);
        const sim::ContactSums before = *simulation->statistics().contactSums;
        const bool dense = share > 0.1;
        run(*simulation, dense ? 11 : 1);
        const sim::Statistics now = simulation->statistics();
        const sim::ContactSums sums = now.contactSums->since(before);
        const double d = 2 * one.radius;
        const double reach = one.side - d;
        const double pressure = (2 * now.kineticEnergy + trace(sums.virial) / sums.seconds) / (3 * std::pow(reach, 3));
        const double count = simulation->count();
        double n = count / std::pow(reach, 3);
        for (int k = 0; k < 20; ++k)
            n = (count - 6 * reach * reach * std::numbers::pi * n * n * std::pow(d, 4) / 8) / std::pow(reach, 3);
        const double eta = n * std::numbers::pi * d * d * d / 6;
        const double z = (1 + eta + eta * eta - eta * eta * eta) / std::pow(1 - eta, 3);
        const double expected = n * 2 * now.kineticEnergy / (3 * count) * z;
        EXPECT_NEAR(pressure / expected, 1, 0.02) << share;
        if (!dense) continue;
        // The virial theorem holds only on average: it takes a million collisions.
        EXPECT_GT(sums.collisions, 1e6);
        // The force on six walls, over their area for the centres.
        double force = 0;
        for (std::size_t face = 0; face < 6; ++face) {
            const glm::dvec3& impulse = sums.loads[face].impulse;
            force += (face % 2 == 0 ? -1 : 1) * impulse[static_cast<int>(face / 2)] / sums.seconds;
        }
        const double onWalls = force / (6 * reach * reach) / pressure;
        EXPECT_NEAR(onWalls, 1, 0.01);
        RecordProperty("onWalls", std::to_string(onWalls));
    }
}

}  // namespace
}  // namespace spherule::physics
