// Periodic axes: what happens across a seam is what happens elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "diagnostics/energy_watch.h"
#include "periodic_gas.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr std::array models = {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate};

std::string nameOfModel(const testing::TestParamInfo<scene::Model>& parameter) {
    return std::string(scene::nameOf(parameter.param));
}

glm::dvec3 randomDirection(scene::Random& random) {
    return glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
}

// A multiple of 2^-20 m: exact as float32 near the bounds, and after a shift by another multiple.
glm::dvec3 exact(glm::dvec3 place) {
    for (int axis = 0; axis < 3; ++axis) place[axis] = std::ldexp(std::round(std::ldexp(place[axis], 20)), -20);
    return place;
}

constexpr double largeRadius = 0.042;  // m
constexpr double side = 1;             // m; float32 resolves 7e-7 radii near its faces

// Two spheres that meet in the middle of periodic bounds, at a random angle, in a frame that drifts.
scene::Scene meeting(scene::Model model, scene::Random& random, double phase) {
    scene::Scene scene = measure::openSpace(side);
    scene.bounds.open.fill(false);
    scene.bounds.periodic.fill(true);
    const double friction = random.uniform() < 0.5 ? 0.4 : 0;
    scene.materials = {{.density = 1000, .restitution = random.uniform(0.3, 1), .friction = friction}};
    const double other = random.uniform() < 0.5 ? largeRadius : largeRadius * random.uniform(0.2, 0.9);
    const glm::dvec3 normal = randomDirection(random);
    const glm::dvec3 across = glm::normalize(glm::cross(normal, randomDirection(random)));
    const double angle = random.uniform(0, 1.2);
    const glm::dvec3 approach = random.uniform(0.8, 1.6) * (std::sin(angle) * across - std::cos(angle) * normal);
    const glm::dvec3 drift = random.uniform() < 0.3 ? glm::dvec3(0) : 0.7 * randomDirection(random);
    const double flight = (3 + phase) / 480;
    const glm::dvec3 first = exact(-drift * flight);
    const glm::dvec3 apart = exact(normal * (largeRadius + other) - approach * flight);
    const glm::vec3 spin = friction > 0 ? glm::vec3(4.0 * randomDirection(random)) : glm::vec3(0);
    measure::addSphere(scene, first, largeRadius, drift + 0.5 * approach).spin = spin;
    measure::addSphere(scene, exact(first - apart), other, drift - 0.5 * approach).spin = -spin;
    scene.quality = {.model = model, .substepsFixed = false};
    scene.quality.substeps = static_cast<std::uint32_t>(scene::defaultSubsteps(scene));
    return scene;
}

// Moves all spheres by `by` (m), and back into the bounds.
void shift(scene::Scene& scene, const glm::dvec3& by) {
    for (scene::Sphere& sphere : scene.spheres) {
        sphere.position += by;
        for (int axis = 0; axis < 3; ++axis)
            sphere.position[axis] -= side * std::floor(sphere.position[axis] / side + 0.5);
    }
}

class Seam : public testing::TestWithParam<scene::Model> {};

// Returns the largest difference of the two motions: positions in radii, velocities in m/s, spins times radius.
double differenceOf(const sim::State& a, const sim::State& b) {
    const glm::dvec3 periods(side);
    const auto between = [&](const sim::State& state) {
        return scene::separation(positionOf(state, 0), positionOf(state, 1), periods);
    };
    double most = glm::length(between(a) - between(b)) / largeRadius;
    for (const std::uint32_t id : {0U, 1U}) {
        most = std::max(most, glm::length(velocityOf(a, id) - velocityOf(b, id)));
        most = std::max(most, radiusOf(a, id) * glm::length(spinOf(a, id) - spinOf(b, id)));
    }
    return most;
}

TEST_P(Seam, SpheresMeetThereAsInTheMiddle) {
    const int cases = GetParam() == scene::Model::Accurate ? 20 : 60;
    scene::Random random(17);
    double most = 0;
    int turned = 0;
    for (int k = 0; k < cases; ++k) {
        const scene::Scene middle = meeting(GetParam(), random, random.uniform());
        scene::Scene seam = middle;
        // Onto a face, an edge or a corner, up to a radius from it.
        glm::dvec3 by(0);
        while (by == glm::dvec3(0))
            for (int axis = 0; axis < 3; ++axis)
                by[axis] = random.uniform() < 0.5 ? 0 : 0.5 * side + random.uniform(-1, 1) * largeRadius;
        shift(seam, exact(by));
        const auto inMiddle = simulate(middle);
        const auto atSeam = simulate(seam);
        const double before = momentumScale(atSeam->snapshot());
        const glm::dvec3 momentum = momentumOf(atSeam->snapshot());
        run(*inMiddle, 1.0 / 60);
        run(*atSeam, 1.0 / 60);
        const sim::State a = inMiddle->snapshot();
        const sim::State b = atSeam->snapshot();
        most = std::max(most, differenceOf(a, b));
        EXPECT_LT(glm::length(momentumOf(b) - momentum), 1e-6 * before);
        turned += glm::length(velocityOf(a, 0) - glm::dvec3(middle.spheres[0].velocity)) > 0.1 ? 1 : 0;
    }
    EXPECT_LT(most, 1e-5);
    EXPECT_GT(turned, cases * 3 / 4) << "most spheres must have met";
    RecordProperty("difference", std::to_string(most * 1e6) + "e-6");
}

TEST_P(Seam, KeepsTheMomentumOfAGas) {
    scene::Scene scene = periodicGas({.count = 500, .fraction = 0.2, .spread = 1, .ratio = 3}, 3);
    setRestitution(scene, 0.8);
    chooseModel(scene, GetParam(), 0.1);
    const auto simulation = simulate(scene);
    const sim::State before = simulation->snapshot();
    run(*simulation, GetParam() == scene::Model::Accurate ? 0.2 : 1);
    const sim::State after = simulation->snapshot();
    ASSERT_TRUE(allFinite(after));
    EXPECT_LT(glm::length(momentumOf(after) - momentumOf(before)), 1e-5 * momentumScale(before));
    EXPECT_LT(kineticEnergyOf(after), 0.9 * kineticEnergyOf(before)) << "they must have met";
    for (std::uint32_t id = 0; id < after.count(); ++id)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LE(std::abs(positionOf(after, id)[axis]), 0.5 * sideOf(scene) * (1 + 1e-6));
    EXPECT_EQ(simulation->statistics().outside, 0U);
}

// The unwrapped path of a sphere has no jump, and follows its velocity.
TEST_P(Seam, PathsContinueAcrossIt) {
    scene::Scene scene = periodicGas({.count = 256, .fraction = 0.05, .spread = 2, .ratio = 1}, 5);
    chooseModel(scene, GetParam(), 0.2);
    const auto simulation = simulate(scene);
    const glm::dvec3 periods = scene.bounds.periods();
    sim::State before = simulation->snapshot();
    std::uint32_t crossings = 0;
    const int steps = GetParam() == scene::Model::Accurate ? 60 : 240;
    for (int step = 0; step < steps; ++step) {
        run(*simulation, scene.step);
        const sim::State after = simulation->snapshot();
        for (std::uint32_t id = 0; id < after.count(); ++id) {
            const glm::dvec3 moved = unwrappedOf(after, id, periods) - unwrappedOf(before, id, periods);
            ASSERT_LT(glm::length(moved), 12 * scene.step) << id << " in step " << step;
            if (after.images[id] != before.images[id]) ++crossings;
        }
        before = after;
    }
    EXPECT_GT(crossings, 50U);
}

// A spawn adds spheres, and does not change the paths of the others.
TEST(Periodic, SpawnKeepsThePathsAndResetBeginsThemAgain) {
    scene::Scene scene = periodicGas({.count = 256, .fraction = 0.05, .spread = 2, .ratio = 1}, 6);
    chooseModel(scene, scene::Model::Balanced, 0.1);
    const auto simulation = simulate(scene);
    run(*simulation, 1);
    const sim::State before = simulation->snapshot();
    const sim::Spawn spawn{
        .name = "one", .look = {}, .place = [](const scene::Scene&, Progress&) -> Result<std::vector<scene::Sphere>> {
            return std::vector<scene::Sphere>{scene::Sphere{.position = {0, 0, 0}, .radius = 0.01F}};
        }};
    ASSERT_TRUE(simulation->apply(spawn));
    const sim::State after = simulation->snapshot();
    ASSERT_EQ(after.count(), before.count() + 1);
    for (std::uint32_t id = 0; id < before.count(); ++id) EXPECT_EQ(after.images[id], before.images[id]) << id;
    EXPECT_EQ(after.images.back(), glm::ivec3(0));
    ASSERT_TRUE(simulation->apply(sim::Reset{}));
    for (const glm::ivec3& images : simulation->snapshot().images) EXPECT_EQ(images, glm::ivec3(0));
}

// A sphere for which the bounds are too short is refused, and the simulation goes on.
TEST(Periodic, SpawnOfATooLargeSphereIsRefused) {
    scene::Scene scene = periodicGas({.count = 256, .fraction = 0.05, .spread = 1, .ratio = 1}, 7);
    chooseModel(scene, scene::Model::Balanced, 0.1);
    const auto simulation = simulate(scene);
    const sim::Spawn spawn{.place = [](const scene::Scene&, Progress&) -> Result<std::vector<scene::Sphere>> {
        return std::vector<scene::Sphere>{scene::Sphere{.position = {0, 0, 0}, .radius = 0.3F}};
    }};
    const auto done = simulation->apply(spawn);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().where, "bounds.periodic");
    EXPECT_EQ(simulation->count(), 256U);
    run(*simulation, 0.1);
    // `fast` lists pairs up to a smaller gap than `balanced`.
    scene = periodicGas({.count = 256, .fraction = 0.1, .spread = 1, .ratio = 1}, 7);
    chooseModel(scene, scene::Model::Fast, 0.1);
    const auto fast = simulate(scene);
    EXPECT_FALSE(fast->apply(sim::Set{.model = scene::Model::Balanced}));
    EXPECT_EQ(fast->scene().quality.model, scene::Model::Fast);
    run(*fast, 0.1);
}

// A bed on a floor, in bounds that are periodic across it, under gravity that is inclined by `degrees`.
scene::Scene chute(scene::Model model, double degrees, std::uint64_t seed) {
    scene::Scene scene = measure::openSpace(1.2);
    scene.bounds.open.fill(false);
    scene.bounds.open[scene::ZMax] = true;
    scene.bounds.periodic = {true, true, false};
    scene.materials = {{.restitution = 0.3, .friction = 0.5}};
    const double angle = degrees * std::numbers::pi / 180;
    scene.forces.gravity = earth * glm::dvec3(std::sin(angle), 0, -std::cos(angle));
    scene.sleep.enabled = true;
    scene::Random random(seed);
    for (int k = 0; k < 300; ++k) {
        const glm::dvec3 place(k % 10, k / 10 % 10, k / 100);
        glm::dvec3 position = -0.54 + 0.12 * place;
        for (int axis = 0; axis < 3; ++axis) position[axis] += random.uniform(-0.005, 0.005);
        measure::addSphere(scene, position, random.uniform(0.04, 0.05));
    }
    chooseModel(scene, model, 0.2);
    return scene;
}

diagnostics::EnergyWatch::Reading readingOf(const sim::Statistics& statistics) {
    return {.step = statistics.step,
            .kinetic = statistics.kineticEnergy + statistics.rotationalEnergy,
            .potential = statistics.potentialEnergy,
            .elastic = statistics.elasticEnergy,
            .given = statistics.pushWork - statistics.unboundedEnergy};
}

// Runs and reads the statistics ten times a second. Returns the alarms of the energy watch.
std::string alarmsOf(sim::Simulation& simulation, double seconds) {
    diagnostics::EnergyWatch watch;
    std::string alarms;
    for (int reading = 0; reading < 10 * seconds; ++reading) {
        run(simulation, 0.1);
        if (const auto alarm = watch.check(readingOf(simulation.statistics()))) alarms += *alarm + "\n";
    }
    return alarms;
}

TEST_P(Seam, AnInclinedBedFlowsAcrossIt) {
    scene::Scene scene = chute(GetParam(), 40, 1);
    const auto simulation = simulate(scene);
    EXPECT_EQ(alarmsOf(*simulation, GetParam() == scene::Model::Accurate ? 0.6 : 1.5), "");
    const sim::Statistics now = simulation->statistics();
    EXPECT_EQ(now.nonFinite, 0U);
    EXPECT_EQ(now.outside, 0U);
    EXPECT_EQ(now.sleeping, 0U) << "gravity moves all of them";
    EXPECT_GT(now.momentum.x, 0);
    EXPECT_LT(now.unboundedEnergy, 0);
    EXPECT_LT(now.overlapMax, 0.5);
}

TEST(Periodic, ABedOnAGentleInclineRestsAndSleeps) {
    const auto simulation = simulate(chute(scene::Model::Balanced, 8, 2));
    EXPECT_EQ(alarmsOf(*simulation, 4), "");
    const sim::Statistics now = simulation->statistics();
    EXPECT_GT(now.sleeping, 290U);
    EXPECT_LT(now.overlapMean, 0.05);
}

// Gravity along a periodic axis accelerates for ever. The fall never rests, and its energy is accounted for.
TEST_P(Seam, SpheresFallAcrossItForEver) {
    scene::Scene scene = measure::openSpace(1.2);
    scene.bounds.open.fill(false);
    scene.bounds.periodic.fill(true);
    scene.forces.gravity = {0, 0, -1};
    scene.sleep.enabled = true;
    measure::addSphere(scene, {0, 0, 0.3}, 0.05);
    measure::addSphere(scene, {0, 0.02, -0.3}, 0.05);
    chooseModel(scene, GetParam(), 0.2);
    const auto simulation = simulate(scene);
    const double before = simulation->statistics().unboundedEnergy;
    EXPECT_EQ(alarmsOf(*simulation, 3), "");
    const sim::Statistics now = simulation->statistics();
    EXPECT_EQ(now.sleeping, 0U);
    EXPECT_NEAR(now.speedRms, 3, 1e-4);
    EXPECT_NEAR(now.kineticEnergy + now.unboundedEnergy - before, 0, 1e-4 * now.kineticEnergy);
    EXPECT_NEAR(unwrappedOf(simulation->snapshot(), 0, scene.bounds.periods()).z, 0.3 - 4.5, 1e-3);
}

// A sphere that moves into a sleeping neighbour's image wakes it.
TEST(Periodic, SleepersWakeAcrossTheSeam) {
    scene::Scene scene = sleepyBox(2);
    scene.bounds.periodic = {true, true, false};
    measure::addSphere(scene, {0.98, 0, -0.95}, 0.05);
    measure::addSphere(scene, {-0.5, 0, -0.95}, 0.05);
    const auto simulation = simulate(scene);
    run(*simulation, 1.5);
    ASSERT_EQ(sleepers(simulation->snapshot()), 2U);
    const double mass = massOf(simulation->snapshot(), 1);
    ASSERT_TRUE(simulation->apply(sim::Push{.target = std::uint32_t{1}, .impulse = {-mass, 0, 0}}));
    run(*simulation, 0.7);
    EXPECT_LT(velocityOf(simulation->snapshot(), 0).x, -0.2);
}

// Without contacts there are no lists, and no rebuild at which spheres are moved back.
TEST_P(Seam, SpheresWithoutContactsCrossIt) {
    scene::Scene scene = measure::openSpace(1);
    scene.bounds.open.fill(false);
    scene.bounds.periodic = {true, true, false};
    scene.sphereContacts = false;
    setRestitution(scene, 1);
    measure::addSphere(scene, {0.3, 0.4, 0}, 0.2, {3, -1.5, 0.7});
    measure::addSphere(scene, {0.3, 0.4, 0}, 0.05);
    chooseModel(scene, GetParam(), 0.2);
    const auto simulation = simulate(scene);
    run(*simulation, 2);
    const sim::State after = simulation->snapshot();
    const glm::dvec3 place = unwrappedOf(after, 0, scene.bounds.periods());
    EXPECT_NEAR(place.x, 6.3, 1e-4);
    EXPECT_NEAR(place.y, -2.6, 1e-4);
    EXPECT_LE(std::abs(positionOf(after, 0).z), 0.31) << "z has walls";
    EXPECT_EQ(after.images[0], glm::ivec3(6, -3, 0));
}

// Bounds that are too short are refused with the figures, and the shortest ones that are not work.
TEST(Periodic, BoundsHoldAtLeastEightCells) {
    for (const scene::Model model : models) {
        const double margin = model == scene::Model::Balanced ? 0.8 : 0.3;
        const double shortest = 8 * (2 + margin) * static_cast<double>(0.05F);
        for (const double length : {shortest * 0.999, shortest * 1.00001}) {
            scene::Scene scene = measure::openSpace(length);
            scene.bounds.open.fill(false);
            scene.bounds.periodic = {true, false, false};
            measure::addSphere(scene, {0.49 * length, 0, 0}, 0.05, {1, 0, 0});
            measure::addSphere(scene, {-0.3 * length, 0, 0}, 0.05);
            chooseModel(scene, model, 0.2);
            const auto made = sim::Simulation::create(device(), scene);
            EXPECT_EQ(made.has_value(), length > shortest);
            if (!made) {
                EXPECT_NE(made.error().text().find("8 cells"), std::string::npos) << made.error().text();
                continue;
            }
            run(**made, 0.5);
            EXPECT_GT(velocityOf((*made)->snapshot(), 1).x, 0.2);
        }
    }
}

class PeriodicGas : public testing::TestWithParam<std::tuple<scene::Model, double>> {};

// Carnahan and Starling 1969, for hard spheres that keep their energy.
TEST_P(PeriodicGas, HasThePressureOfHardSpheres) {
    const auto [model, fraction] = GetParam();
    const auto count = static_cast<std::uint32_t>(model == scene::Model::Balanced ? (fraction < 0.3 ? 864 : 1372)
                                                                                  : (fraction < 0.3 ? 500 : 864));
    const GasPressure found = pressureOf(model, fraction, count, 1, model == scene::Model::Accurate ? 8'000 : 60'000);
    EXPECT_NEAR(found.compressibility / carnahanStarling(fraction), 1, 0.02);
    RecordProperty("ratio", std::to_string(found.compressibility / carnahanStarling(fraction)));
    RecordProperty("impacts", std::to_string(found.impacts));
}

INSTANTIATE_TEST_SUITE_P(Of, PeriodicGas,
                         testing::Combine(testing::Values(scene::Model::Balanced, scene::Model::Accurate),
                                          testing::Values(0.2, 0.4)),
                         [](const auto& parameter) {
                             return std::string(scene::nameOf(std::get<0>(parameter.param))) +
                                    std::to_string(std::lround(100 * std::get<1>(parameter.param))) + "Percent";
                         });

// The kinetic theory of gases: n v / 4 spheres cross a unit of area in a second, each way.
TEST(Periodic, TheFluxThroughASeamIsThatOfAGas) {
    const GasFlux found = fluxOf(scene::Model::Fast, 500, 1, 30'000);
    EXPECT_NEAR(found.measured / found.expected, 1, 0.02);
    RecordProperty("ratio", std::to_string(found.measured / found.expected));
    RecordProperty("crossings", std::to_string(found.crossings));
}

INSTANTIATE_TEST_SUITE_P(Of, Seam, testing::ValuesIn(models), nameOfModel);

}  // namespace
}  // namespace spherule::physics
