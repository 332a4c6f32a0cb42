// Spheres that are added and removed while a simulation runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {
namespace {

using measure::addSphere;
using measure::setFriction;

constexpr float radius = 0.05F;  // m

class Population : public testing::TestWithParam<scene::Model> {};

void choose(scene::Scene& scene, scene::Model model) {
    scene.quality.model = model;
    scene.quality.substepsFixed = false;
    ASSERT_TRUE(scene::fitSubsteps(scene));
}

// A heap of `count` spheres in a box of 1 m, with friction.
scene::Scene heap(scene::Model model, int count) {
    scene::Scene scene = sleepyBox(1);
    setFriction(scene, 0.3);
    for (int k = 0; k < count; ++k)
        addSphere(scene,
                  glm::dvec3(0.11 * (k % 8) - 0.39, 0.11 * (k / 8 % 8) - 0.39 + 0.003 * (k / 64 % 2),
                             -0.44 + 0.11 * (k / 64)),
                  radius);
    choose(scene, model);
    return scene;
}

sim::Spawn spawnAt(std::vector<glm::dvec3> places, float size = radius) {
    return {.name = "new", .look = {}, .place = [places = std::move(places), size](const scene::Scene&, Progress&) {
                std::vector<scene::Sphere> spheres;
                for (const glm::dvec3& place : places) spheres.push_back({.position = place, .radius = size});
                return Result<std::vector<scene::Sphere>>(std::move(spheres));
            }};
}

bool sameState(const sim::State& a, std::uint32_t i, const sim::State& b, std::uint32_t k) {
    return a.position[i] == b.position[k] && a.velocity[i] == b.velocity[k] && a.spin[i] == b.spin[k];
}

// The number of spheres that the device counts, of which none is non-finite.
void expectCounts(sim::Simulation& simulation) {
    const sim::Statistics now = simulation.statistics();
    EXPECT_EQ(now.born, now.spheres + now.removed);
    EXPECT_EQ(now.spheres, simulation.snapshot().count());
    EXPECT_EQ(now.spheres, simulation.scene().spheres.size());
    EXPECT_EQ(now.nonFinite, 0U);
    std::uint32_t inGroups = 0;
    for (const scene::Group& group : simulation.scene().groups) inGroups += group.count;
    EXPECT_LE(inGroups, now.spheres);
}

TEST_P(Population, KeepsTheOtherSpheresAndTheirNumbers) {
    auto simulation = simulate(heap(GetParam(), 200));
    run(*simulation, 0.1);
    const sim::State before = simulation->snapshot();
    const auto applied = simulation->apply(sim::Remove{.spheres = {17, 3, 199, 17}});
    ASSERT_TRUE(applied);
    EXPECT_EQ(applied->removed, 3U);
    const sim::State after = simulation->snapshot();
    ASSERT_EQ(after.count(), 197U);
    for (std::uint32_t rank = 0; rank < after.count(); ++rank) {
        const auto id = static_cast<std::uint32_t>(after.idAt(rank));
        EXPECT_TRUE(id != 3 && id != 17 && id != 199);
        EXPECT_TRUE(sameState(after, rank, before, id)) << id;
    }
    ASSERT_TRUE(simulation->apply(spawnAt({{0.2, 0.2, 0.3}, {-0.2, 0.2, 0.3}})));
    EXPECT_EQ(simulation->snapshot().idAt(198), 201U);
    run(*simulation, 0.2);
    expectCounts(*simulation);
    EXPECT_EQ(simulation->statistics().born, 202U);
}

// Two pyramids of five spheres at rest, which friction holds together, and loose spheres far away: the pyramids do not
// notice when these are removed and others are added. Without the memory of their contacts they would start anew.
TEST_P(Population, KeepsTheMemoryOfContacts) {
    scene::Scene scene = sleepyBox(3);
    scene.sleep.enabled = false;
    setFriction(scene, 0.5);
    for (const double x : {-0.8, 0.8}) {
        for (int k = 0; k < 4; ++k) addSphere(scene, {x + 0.1 * (k % 2), 0.1 * (k / 2), -1.45}, radius);
        addSphere(scene, {x + 0.05, 0.05, -1.45 + 0.1 / std::sqrt(2.0)}, radius);
    }
    for (int k = 0; k < 6; ++k) addSphere(scene, {0.3 * k - 0.8, 1.2, -1.45}, radius);
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    run(*simulation, 2);
    const auto farthest = [](const sim::State& a, const sim::State& b) {
        double moved = 0;
        for (std::uint32_t id = 0; id < 10; ++id)
            moved = std::max(moved, glm::length(positionOf(a, id) - positionOf(b, id)));
        return moved;
    };
    const sim::State before = simulation->snapshot();
    run(*simulation, 0.5);
    const sim::State calm = simulation->snapshot();
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {11, 13}}));
    ASSERT_TRUE(simulation->apply(spawnAt({{-0.5, 1.2, -1.45}, {0.1, 1.2, -1.45}})));
    run(*simulation, 0.5);
    const sim::State after = simulation->snapshot();
    EXPECT_LT(farthest(calm, after), 2e-5 + 1.5 * farthest(before, calm));
    if (GetParam() != scene::Model::Accurate) return;
    simulation->upload(after);  // forgets what contacts hold
    run(*simulation, 0.5);
    EXPECT_GT(farthest(after, simulation->snapshot()), 10 * farthest(calm, after)) << "the case shows a loss";
}

TEST_P(Population, NeverUsesAnIdAgainAndKeepsItsMemory) {
    constexpr std::uint64_t first = (1U << 24U) - 100;
    auto simulation = simulate(heap(GetParam(), 64));
    simulation->setFirstId(first);
    scene::Random random(7);
    std::optional<std::uint64_t> bytes;
    std::uint64_t newest = first + 63;
    const int rounds = GetParam() == scene::Model::Accurate ? 12 : 40;
    for (int round = 0; round < rounds; ++round) {
        const sim::State state = simulation->snapshot();
        sim::Remove remove;
        for (std::uint32_t k = 0; k < 10; ++k)
            remove.spheres.push_back(state.idAt(static_cast<std::uint32_t>(random.uniform(0, state.count()))));
        const auto removed = simulation->apply(remove);
        ASSERT_TRUE(removed) << removed.error().text();
        std::vector<glm::dvec3> places;
        for (std::uint32_t k = 0; k < *removed->removed; ++k)
            places.emplace_back(0.11 * (k % 4) - 0.2, 0.11 * (k / 4) - 0.2, 0.3);
        ASSERT_TRUE(simulation->apply(spawnAt(places)));
        newest += places.size();
        EXPECT_EQ(simulation->snapshot().ids.back(), newest);
        for (int step = 0; step < 3; ++step) {
            ASSERT_TRUE(simulation->step());
            expectCounts(*simulation);
        }
        if (round == 5) bytes = simulation->plan().bytes();
    }
    EXPECT_GT(newest, std::uint64_t{1} << 24U);
    EXPECT_EQ(simulation->plan().bytes(), *bytes) << "handles are used again";
    EXPECT_LT(simulation->population().handles(), 128U);
    const std::uint64_t last = simulation->population().idAt(0);
    EXPECT_TRUE(simulation->apply(sim::Remove{.spheres = {last}}));
    EXPECT_FALSE(simulation->apply(sim::Remove{.spheres = {last}}));
}

std::uint64_t hashAfterChanges(scene::Model model, const std::string& choice) {
    const auto device = compute::openDevice(choice).value();
    scene::Scene scene = heap(model, 150);
    scene.sinks = {{{-0.5, -0.5, -0.5}, {-0.25, 0.5, -0.38}}};
    auto simulation = simulate(scene, *device);
    simulation->setFirstId((1U << 24U) - 155);
    const bool brief = model == scene::Model::Accurate;
    for (int round = 0; round < 3; ++round) {
        run(*simulation, brief ? 0.034 : 0.1);
        const sim::State state = simulation->snapshot();
        EXPECT_TRUE(simulation->apply(sim::Remove{.spheres = {state.idAt(30), state.idAt(70)}}));
        EXPECT_TRUE(simulation->apply(spawnAt({{0.2, 0.1 * round, 0.3}, {-0.2, 0, 0.3}, {0, 0.2, 0.3}})));
    }
    run(*simulation, brief ? 0.034 : 0.3);
    EXPECT_GT(simulation->population().removed(), 6U) << "the sink takes spheres";
    return sim::hashOf(simulation->snapshot());
}

TEST_P(Population, HasTheSameBitsOnAllDevices) {
    const std::uint64_t expected = hashAfterChanges(GetParam(), "cpu:1x1");
    for (const char* const choice : {"software", "cpu:2x4", "cpu:3x8"})
        EXPECT_EQ(hashAfterChanges(GetParam(), choice), expected) << choice;
}

TEST_P(Population, SinksTakeSpheresAtTheEndOfTheStep) {
    scene::Scene scene = fineStepSpace(2);
    scene.step = 1.0 / 60;
    scene.sphereContacts = GetParam() != scene::Model::Fast;  // also a plan without cells
    for (int k = 0; k < 20; ++k)
        addSphere(scene, {-0.9031, -0.95 + 0.1 * k, 0}, 0.04).velocity = {1.0F + 0.1F * static_cast<float>(k), 0, 0};
    scene.sinks = {{{0, -1, -1}, {1, 1, 1}}};
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    for (int step = 0; step < 70; ++step) {
        ASSERT_TRUE(simulation->step());
        const sim::State state = simulation->snapshot();
        std::vector<std::uint64_t> left;
        for (std::uint32_t k = 0; k < 20; ++k)
            if (-0.9031 + (1 + 0.1 * k) * simulation->time() < 0) left.push_back(k);
        ASSERT_EQ(state.count(), left.size()) << "in step " << step;
        for (std::uint32_t rank = 0; rank < state.count(); ++rank) {
            EXPECT_EQ(state.idAt(rank), left[rank]);
            EXPECT_NEAR(positionOf(state, rank).x,
                        -0.9031 + (1 + 0.1 * static_cast<double>(left[rank])) * simulation->time(), 1e-4);
        }
    }
    EXPECT_EQ(simulation->count(), 0U) << "an empty world goes on";
    expectCounts(*simulation);
    ASSERT_TRUE(simulation->apply(spawnAt({{-0.5, 0, 0}})));
    ASSERT_TRUE(simulation->step());
    EXPECT_EQ(simulation->snapshot().idAt(0), 20U);
}

// The scene has no spheres any more that the new one could differ from, but the plan has one radius for all.
TEST_P(Population, ChangesThePlanForAnotherRadius) {
    scene::Scene scene = sleepyBox(1);
    scene.sphereContacts = false;
    addSphere(scene, {0, 0, 0}, 0.1);
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {0}}));
    ASSERT_TRUE(simulation->apply(spawnAt({{0, 0, -0.29}}, 0.2F)));
    EXPECT_EQ(simulation->snapshot().idAt(0), 1U);
    run(*simulation, 1);
    EXPECT_NEAR(positionOf(simulation->snapshot(), 0).z, -0.3, 0.005);
}

TEST_P(Population, RemovesByRegion) {
    auto simulation = simulate(heap(GetParam(), 128));
    const sim::State before = simulation->snapshot();
    std::uint32_t inside = 0;
    const scene::Box region{{-0.3, -0.3, -0.5}, {0.1, 0.1, -0.4}};
    for (std::uint32_t id = 0; id < before.count(); ++id) inside += region.contains(positionOf(before, id)) ? 1 : 0;
    ASSERT_GT(inside, 3U);
    const auto removed = simulation->apply(sim::Remove{.spheres = {}, .region = region});
    ASSERT_TRUE(removed);
    EXPECT_EQ(removed->removed, inside);
    const auto again = simulation->apply(sim::Remove{.spheres = {}, .region = region});
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().where, "region");
}

TEST_P(Population, GoesBackToTheSpheresOfTheLastGoodState) {
    auto simulation = simulate(heap(GetParam(), 64));
    ASSERT_TRUE(simulation->step());
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {5}}));
    ASSERT_TRUE(simulation->apply(spawnAt({{0, 0, 0.3}})));
    sim::State broken = simulation->snapshot();
    broken.velocity[10].x = std::numeric_limits<float>::quiet_NaN();
    simulation->upload(broken);
    ASSERT_TRUE(simulation->step());
    ASSERT_TRUE(simulation->counters().nonFinite);
    EXPECT_NE(simulation->divergence().find("sphere 11 "), std::string::npos) << simulation->divergence();
    simulation->rollback();
    EXPECT_EQ(simulation->count(), 64U);
    EXPECT_EQ(simulation->statistics().removed, 1U) << "the birth that is undone";
    ASSERT_TRUE(simulation->apply(spawnAt({{0, 0, 0.3}})));
    EXPECT_EQ(simulation->snapshot().ids.back(), 65U) << "its id is not used again";
    run(*simulation, 0.1);
    expectCounts(*simulation);
    EXPECT_FALSE(simulation->counters().nonFinite);
}

INSTANTIATE_TEST_SUITE_P(Of, Population,
                         testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& model) { return std::string(scene::nameOf(model.param)); });

class SleepingPopulation : public testing::TestWithParam<scene::Model> {
  protected:
    // A bed, all asleep: one layer of touching spheres in `fast`, which settles higher beds slowly, else three layers.
    static std::unique_ptr<sim::Simulation> sleepingBed() {
        scene::Scene scene = sleepyBox(1.2);
        setFriction(scene, 0.4);
        setRestitution(scene, 0);
        const bool flat = GetParam() == scene::Model::Fast;
        const double pitch = flat ? 0.1 : 0.107;
        for (int k = 0; k < (flat ? 121 : 363); ++k)
            addSphere(scene,
                      {pitch * (k % 11 - 5), pitch * (k / 11 % 11 - 5), -0.55 + pitch * static_cast<double>(k / 121)},
                      radius);
        choose(scene, GetParam());
        auto simulation = simulate(scene);
        for (int k = 0; k < 40 && sleepers(simulation->snapshot()) < simulation->count(); ++k) run(*simulation, 0.25);
        EXPECT_EQ(sleepers(simulation->snapshot()), simulation->count());
        return simulation;
    }

    // The spheres that are awake and farther from `place` than `reach` (m).
    static std::uint32_t awakeBeyond(sim::Simulation& simulation, const glm::dvec3& place, double reach) {
        const sim::State state = simulation.snapshot();
        std::uint32_t count = 0;
        for (std::uint32_t rank = 0; rank < state.count(); ++rank)
            count += !asleep(state, rank) && glm::distance(positionOf(state, rank), place) > reach ? 1 : 0;
        return count;
    }
};

TEST_P(SleepingPopulation, WakesOnlyNeighboursOfARemovedSphere) {
    auto simulation = sleepingBed();
    const sim::State before = simulation->snapshot();
    std::uint32_t below = 0;  // the sphere in the middle of the lowest layer
    for (std::uint32_t id = 1; id < before.count(); ++id)
        if (glm::distance(positionOf(before, id), {0, 0, -0.55}) <
            glm::distance(positionOf(before, below), {0, 0, -0.55}))
            below = id;
    const glm::dvec3 place = positionOf(before, below);
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {below}}));
    EXPECT_GT(simulation->count() - sleepers(simulation->snapshot()), 2U) << "its neighbours wake";
    EXPECT_EQ(awakeBeyond(*simulation, place, 2.5 * 2 * 0.05), 0U);
    ASSERT_TRUE(simulation->step());
    EXPECT_EQ(awakeBeyond(*simulation, place, 5 * 2 * 0.05), 0U);
    if (GetParam() == scene::Model::Fast) return;
    run(*simulation, 1);
    // The spheres above have come down.
    const sim::State after = simulation->snapshot();
    double lowest = 1;
    for (std::uint32_t rank = 0; rank < after.count(); ++rank) {
        const glm::dvec3 x = positionOf(after, rank);
        if (std::hypot(x.x - place.x, x.y - place.y) < 0.04) lowest = std::min(lowest, x.z);
    }
    EXPECT_LT(lowest, -0.5);
}

TEST_P(SleepingPopulation, WakesASphereThatRestsOnARemovedFixedOne) {
    scene::Scene scene = sleepyBox(1);
    setFriction(scene, 0.4);
    setRestitution(scene, 0);
    addSphere(scene, {0, 0, -0.2}, radius).fixed = true;
    addSphere(scene, {0, 0, -0.1}, radius);
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    for (int k = 0; k < 20 && sleepers(simulation->snapshot()) == 0; ++k) run(*simulation, 0.25);
    ASSERT_EQ(sleepers(simulation->snapshot()), 1U);
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {0}}));
    EXPECT_EQ(sleepers(simulation->snapshot()), 0U);
    run(*simulation, 1);
    EXPECT_NEAR(positionOf(simulation->snapshot(), 0).z, -0.45, 1e-3);
}

// The last good state is on the device, with images. It stays whole while arrays grow and obstacles change.
TEST_P(Population, GoesBackAfterItsArraysHaveChanged) {
    scene::Scene scene = heap(GetParam(), 128);
    scene.bounds.periodic = {true, false, false};
    scene.bounds.min.x = -0.6;
    scene.bounds.max.x = 0.6;
    for (scene::Sphere& sphere : scene.spheres) sphere.velocity = {1, 0, 0};
    choose(scene, GetParam());
    auto simulation = simulate(scene);
    run(*simulation, 1);
    const sim::State kept = simulation->snapshot();
    ASSERT_TRUE(std::ranges::any_of(kept.images, [](const glm::ivec3& image) { return image.x != 0; }));
    std::vector<glm::dvec3> places;
    for (int k = 0; k < 100; ++k)
        places.emplace_back(0.11 * (k % 8) - 0.39, 0.11 * (k / 8 % 8) - 0.39, 0.2 + 0.11 * (k / 64));
    ASSERT_TRUE(simulation->apply(spawnAt(places)));
    ASSERT_GT(simulation->plan().room, 128U + 64U) << "arrays have grown";
    const scene::Obstacle ceiling{scene::planeShape({0, 0, 0.495}, {0, 0, -1}), 0, ""};
    const auto make = [&](const scene::Scene&) { return Result<std::optional<scene::Obstacle>>(ceiling); };
    const auto changed = simulation->apply(sim::ChangeObstacle{.obstacle = std::nullopt, .make = make});
    ASSERT_TRUE(changed) << changed.error().text();
    sim::State broken = simulation->snapshot();
    broken.velocity[10].x = std::numeric_limits<float>::quiet_NaN();
    simulation->upload(broken);
    ASSERT_TRUE(simulation->step());
    ASSERT_TRUE(simulation->counters().nonFinite);
    simulation->rollback();
    const sim::State back = simulation->snapshot();
    ASSERT_EQ(back.count(), 128U);
    EXPECT_EQ(back.images, kept.images);
    for (std::uint32_t rank = 0; rank < back.count(); ++rank) EXPECT_TRUE(sameState(back, rank, kept, rank)) << rank;
}

// After a return to the last good state, the lists are rebuilt only in the next substep.
TEST_P(SleepingPopulation, WakesNeighboursOfASphereThatIsRemovedAfterAReturn) {
    auto simulation = sleepingBed();
    run(*simulation, 1.5);
    simulation->rollback();
    ASSERT_EQ(sleepers(simulation->snapshot()), simulation->count());
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {60}}));
    EXPECT_GT(simulation->count() - sleepers(simulation->snapshot()), 2U);
}

TEST_P(SleepingPopulation, StaysAsleepBeyondTheReachOfNewSpheres) {
    for (const glm::dvec3 place : {glm::dvec3{0.1, -0.1, -0.24}, {0.2, 0.1, -0.24}, {-0.15, 0, -0.24}}) {
        auto simulation = sleepingBed();
        const std::uint32_t generation = simulation->generation();
        ASSERT_TRUE(simulation->apply(spawnAt({place})));
        EXPECT_EQ(simulation->generation(), generation) << "no new arrays or kernels";
        ASSERT_TRUE(simulation->step());
        EXPECT_EQ(awakeBeyond(*simulation, place, 5 * 2 * 0.05), 0U);
        run(*simulation, 8);  // the slowest of four places took 6 s
        EXPECT_GT(sleepers(simulation->snapshot()), simulation->count() - simulation->count() / 10);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, SleepingPopulation, testing::Values(scene::Model::Fast, scene::Model::Balanced),
                         [](const auto& model) { return std::string(scene::nameOf(model.param)); });

}  // namespace
}  // namespace spherule::physics
