#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "beds.h"
#include "figures.h"
#include "scene/quality.h"
#include "scene/shapes.h"
#include "support.h"

// A bed 20 layers deep falls asleep in `balanced`, and wakes without a jump.
namespace spherule::physics {
namespace {

std::unique_ptr<sim::Simulation> sleepingBed(std::uint64_t seed) {
    scene::Scene scene = bed({.seed = seed});
    scene.sleep.enabled = true;
    auto simulation = simulate(std::move(scene));
    run(*simulation, 6);
    return simulation;
}

// Runs until nine tenths of the spheres sleep, for at most 20 s.
void runToSleep(sim::Simulation& simulation) {
    while (simulation.statistics().sleeping < simulation.count() * 9 / 10 && simulation.time() < 20)
        run(simulation, 0.25);
}

// One sphere that still moves and carries others keeps the blocks around it awake, in so small a bed nearly all. So a
// bed sleeps as a whole or not at all.
TEST(BedSleep, MostBedsSleepAfterSixSeconds) {
    constexpr int beds = 20;
    int asleep = 0;
    for (std::uint64_t seed = 1; seed <= beds; ++seed) {
        SCOPED_TRACE(seed);
        const auto simulation = sleepingBed(seed);
        const sim::Statistics statistics = simulation->statistics();
        if (statistics.sleeping >= simulation->count() * 9 / 10) ++asleep;
        EXPECT_LT(statistics.overlapMean, 0.006) << "spheres fall asleep in their places";
    }
    EXPECT_GE(asleep, 17) << "of " << beds;
    RecordProperty("asleep", asleep);
}

// A jump would follow at once. Later, single spheres fall into gaps, as they do in beds that have never slept: there,
// too, the fastest of 1,000 spheres reaches 0.3 m/s between 5 and 8 s.
TEST(BedSleep, WakesWithoutAJump) {
    double fastestMean = 0;
    double rmsMean = 0;
    int falls = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
        SCOPED_TRACE(seed);
        const auto simulation = sleepingBed(seed);
        runToSleep(*simulation);
        ASSERT_GE(simulation->statistics().sleeping, 900U);
        ASSERT_TRUE(simulation->apply(sim::Set{.gravity = simulation->scene().forces.gravity}));
        ASSERT_EQ(sleepers(simulation->snapshot()), 0U);
        double fastest = 0;
        for (int k = 0; k < 48; ++k) {
            ASSERT_TRUE(simulation->advance());
            fastest = std::max(fastest, simulation->statistics().speedMax);
        }
        if (fastest > 0.09) ++falls;
        fastestMean += fastest / 6;
        run(*simulation, 0.9);
        rmsMean += simulation->statistics().speedRms / 6;
        RecordProperty("fastestSeed" + std::to_string(seed), figure(fastest));
        RecordProperty("rmsSeed" + std::to_string(seed), figure(simulation->statistics().speedRms));
    }
    EXPECT_LE(falls, 1) << "beds in which a sphere exceeds 90 mm/s in 0.1 s";
    EXPECT_LT(fastestMean, 0.06);
    EXPECT_LT(rmsMean, 0.002);
}

// A bed of 8 layers in a box with a shelf above it. The last sphere rests on the shelf. It has 8 times the mass of the
// others.
scene::Scene bedUnderAShelf(std::uint64_t seed) {
    scene::Scene scene = bed({.depth = 8, .seed = seed});
    scene.sleep.enabled = true;
    const double shelf = scene.bounds.max.z + 0.1;
    scene.bounds.max.z += 0.5;
    const glm::dvec3 corner(scene.bounds.min.x, scene.bounds.min.y, shelf - 0.05);
    scene.obstacles.push_back({scene::boxShape({corner, {corner.x + 0.25, -corner.y, shelf}}), 0, ""});
    measure::addSphere(scene, {corner.x + 0.15, 0.02, shelf + 2 * bedRadius}, 2 * bedRadius);
    return scene;
}

// The last sphere rolls from the shelf and hits the sleeping bed at 5 to 6 m/s. It wakes about two layers around it.
TEST(BedSleep, EndsForAllSpheresInReachOfAnImpact) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(seed);
        const auto simulation = simulate(bedUnderAShelf(seed));
        run(*simulation, 6);
        runToSleep(*simulation);
        const std::uint32_t shot = simulation->count() - 1;
        ASSERT_TRUE(asleep(simulation->snapshot(), shot));
        ASSERT_GE(simulation->statistics().sleeping, 900U);
        const double mass = massOf(simulation->snapshot(), shot);
        ASSERT_TRUE(simulation->apply(sim::Push{.target = shot, .impulse = mass * glm::dvec3(0.8, 0, 0)}));
        std::vector<bool> woke(shot, false);
        const auto look = [&] {
            const sim::State now = simulation->snapshot();
            for (std::uint32_t id = 0; id < shot; ++id) woke[id] = woke[id] || !asleep(now, id);
            return now;
        };
        const double end = simulation->time() + 4;
        while (simulation->time() < end && velocityOf(look(), shot).z > -3) run(*simulation, 1.0 / 60);
        woke.assign(shot, false);
        while (simulation->time() < end && velocityOf(look(), shot).z <= -3) ASSERT_TRUE(simulation->advance());
        ASSERT_LT(simulation->time(), end) << "the sphere has not reached the bed";
        const sim::State hit = simulation->snapshot();
        for (int k = 0; k < 15; ++k) {
            run(*simulation, 1.0 / 60);
            look();
        }
        int near = 0;
        int missed = 0;
        for (std::uint32_t id = 0; id < shot; ++id) {
            if (glm::distance(positionOf(hit, id), positionOf(hit, shot)) > 6 * bedRadius) continue;
            ++near;
            if (!woke[id]) ++missed;
        }
        EXPECT_GT(near, 25);
        EXPECT_EQ(missed, 0) << "of " << near;
        EXPECT_LT(simulation->statistics().overlapMax, 0.05) << "a sleeper has been squeezed";
        RecordProperty("near", near);
        RecordProperty("woke", static_cast<int>(std::ranges::count(woke, true)));
        RecordProperty("overlapMax", figure(simulation->statistics().overlapMax));
    }
}

// The time of one call (s).
template <class Call>
double secondsOf(Call call) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double medianOf(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

// 49,154 spheres in three layers. Ten new ones come to lie on them, five times. Only their surroundings wake, and no
// arrays or kernels are made anew. The spawn with its step takes less than three steps of the same bed awake.
TEST(BedSleep, OutlastsASpawnBeyondItsReach) {
    scene::Scene scene = sleepyBox(1);
    constexpr int side = 129;
    constexpr double pitch = 0.106;  // m
    scene.bounds.min = {-0.5 * side * pitch, -0.5 * side * pitch, 0};
    scene.bounds.max = {0.5 * side * pitch, 0.5 * side * pitch, 1};
    measure::setFriction(scene, 0.4);
    setRestitution(scene, 0);
    for (int layer = 0; layer < 3; ++layer) {  // the upper spheres lie in the hollows of the lower ones
        const int along = side - layer;
        for (int k = 0; k < along * along; ++k)
            measure::addSphere(scene,
                               {pitch * (k % along - 0.5 * (along - 1)), pitch * (k / along - 0.5 * (along - 1)),
                                0.0501 + 0.0663 * layer},
                               bedRadius);
    }
    scene.quality.substepsFixed = false;
    ASSERT_TRUE(scene::fitSubsteps(scene));
    auto simulation = simulate(std::move(scene));
    run(*simulation, 3);
    const std::uint32_t before = simulation->count();
    ASSERT_GT(simulation->statistics().sleeping, before * 99 / 100);
    const std::uint32_t generation = simulation->generation();
    std::vector<double> spawning;
    int wokeFar = 0;
    int wokeNear = 0;
    constexpr double reach = 2;  // m: the blocks around one with a restless sphere
    for (int round = 0; round < 5; ++round) {
        const sim::State asleepBefore = simulation->snapshot();
        const double x = 2 * (round - 2);
        const sim::Spawn spawn{.name = "ten", .look = {}, .place = [x](const scene::Scene&, Progress&) {
                                   std::vector<scene::Sphere> ten;
                                   for (int k = 0; k < 10; ++k)
                                       ten.push_back({.position = {x + 0.11 * (k % 5), 0.11 * (k / 5), 0.285},
                                                      .radius = static_cast<float>(bedRadius)});
                                   return Result<std::vector<scene::Sphere>>(std::move(ten));
                               }};
        spawning.push_back(secondsOf([&] {
            ASSERT_TRUE(simulation->apply(spawn));
            ASSERT_TRUE(simulation->step());
        }));
        EXPECT_GE(sleepers(simulation->snapshot()), sleepers(asleepBefore) - 40) << "those within reach";
        run(*simulation, 0.2);
        const sim::State now = simulation->snapshot();
        for (std::uint32_t id = 0; id < before; ++id) {
            if (asleep(now, id) || !asleep(asleepBefore, id)) continue;
            const glm::dvec3 place = positionOf(now, id);
            ++(std::hypot(place.x - x - 0.22, place.y - 0.055) < reach ? wokeNear : wokeFar);
        }
    }
    EXPECT_GT(wokeNear, 50);
    EXPECT_LT(wokeFar, 500) << "beside one that moved on";
    EXPECT_EQ(simulation->generation(), generation);
    ASSERT_TRUE(simulation->apply(sim::Set{.gravity = simulation->scene().forces.gravity}));  // wakes all
    std::vector<double> awake;
    for (int k = 0; k < 5; ++k) awake.push_back(secondsOf([&] { ASSERT_TRUE(simulation->step()); }));
    const double steps = medianOf(spawning) / medianOf(awake);
    EXPECT_LT(steps, 3);
    EXPECT_LT(spawning.front(), 3 * medianOf(awake)) << "the first: no array grows";
    RecordProperty("stepsOfASpawn", figure(steps));
    RecordProperty("firstSpawn", figure(spawning.front() / medianOf(awake)));
    RecordProperty("wokeNear", wokeNear);
}

}  // namespace
}  // namespace spherule::physics
