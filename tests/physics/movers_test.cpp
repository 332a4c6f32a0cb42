// Lists of movers (shaders/shared/movers.h): spheres that move among sleeping ones have lists of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <glm/geometric.hpp>

#include "scene/random.h"
#include "sim/layout.h"
#include "support.h"

namespace spherule::physics {
namespace {

using measure::addSphere;
using measure::setFriction;
using sim::Array;

constexpr float radius = 0.05F;  // m
constexpr double pitch = 0.104;  // m

// A bed of 22 x 22 x `layers` spheres in a box of 2.4 m, which comes to rest in half a second. Further spheres follow.
scene::Scene bedOf(int layers, std::uint64_t seed) {
    scene::Scene scene = sleepyBox(2.4);
    setFriction(scene, 0.4);
    scene.sleep.time = 0.1;
    scene::Random random(seed);
    for (int k = 0; k < 484 * layers; ++k) {
        const glm::dvec3 cell(k % 22, k / 22 % 22, k / 484);
        const glm::dvec3 jitter(random.uniform(-0.001, 0.001), random.uniform(-0.001, 0.001), 0);
        addSphere(scene, glm::dvec3(-1.1, -1.1, -1.15) + pitch * cell * glm::dvec3(1, 1, 0.97) + jitter, radius);
    }
    return scene;
}

std::unique_ptr<sim::Simulation> sleepingBed(std::uint64_t seed, int layers = 5) {
    auto simulation = simulate(bedOf(layers, seed));
    while (sleepers(simulation->snapshot()) < simulation->count() * 9 / 10 && simulation->time() < 8)
        run(*simulation, 0.25);
    EXPECT_GE(sleepers(simulation->snapshot()), simulation->count() * 9 / 10);
    return simulation;
}

std::vector<std::uint32_t> countersOf(sim::Simulation& simulation) {
    return simulation.pipeline().read<std::uint32_t>(Array::Counters);
}

sim::Spawn spawnOf(std::vector<scene::Sphere> spheres) {
    return {.name = "new", .look = {}, .place = [spheres = std::move(spheres)](const scene::Scene&, Progress&) {
                return Result<std::vector<scene::Sphere>>(spheres);
            }};
}

// Spheres with random velocities above the bed, `count` of them.
std::vector<scene::Sphere> rain(scene::Random& random, int count, float speed) {
    std::vector<scene::Sphere> spheres;
    for (int k = 0; k < count; ++k)
        spheres.push_back(
            {.position = {0.11 * (k % 15) - 0.8 + random.uniform(-0.004, 0.004),
                          0.11 * (k / 15) - 0.5 + random.uniform(-0.004, 0.004), random.uniform(-0.3, 0.5)},
             .velocity = {static_cast<float>(random.uniform(-0.5, 0.5)) * speed,
                          static_cast<float>(random.uniform(-0.5, 0.5)) * speed,
                          static_cast<float>(random.uniform(-1, 0.2)) * speed},
             .radius = radius});
    return spheres;
}

// Every pair of spheres that touch is listed, and no pair is listed twice.
void expectCompleteLists(sim::Simulation& simulation) {
    const auto position = simulation.pipeline().read<glm::vec4>(Array::Position, simulation.count());
    const std::vector<SlotPair> listed = listedPairs(simulation);
    EXPECT_EQ(std::ranges::adjacent_find(listed), listed.end()) << "a pair is listed twice";
    std::map<std::array<int, 3>, std::vector<std::uint32_t>> cells;
    const auto cellOf = [&](std::uint32_t slot) {
        const glm::vec3 cell = glm::floor(glm::vec3(position[slot]) / (2 * radius));
        return std::array{static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)};
    };
    for (std::uint32_t slot = 0; slot < position.size(); ++slot) cells[cellOf(slot)].push_back(slot);
    for (std::uint32_t a = 0; a < position.size(); ++a) {
        const std::array<int, 3> own = cellOf(a);
        for (int k = 0; k < 27; ++k) {
            const auto found = cells.find({own[0] + k % 3 - 1, own[1] + k / 3 % 3 - 1, own[2] + k / 9 - 1});
            if (found == cells.end()) continue;
            for (const std::uint32_t b : found->second)
                if (a < b && glm::distance(glm::vec3(position[a]), glm::vec3(position[b])) <= 2 * radius) {
                    ASSERT_TRUE(std::ranges::binary_search(listed, SlotPair(a, b)))
                        << "at " << simulation.time() << " s";
                }
        }
    }
}

// Each sphere that touches no wall holds the sum of the impulses that its contacts hold.
void expectHeldSums(sim::Simulation& simulation) {
    sim::Pipeline& pipeline = simulation.pipeline();
    const auto words = pipeline.read<std::uint32_t>(Array::Bundles);
    const auto pairs = pipeline.read<glm::uvec2>(Array::Pairs);
    const std::array memory{pipeline.read<float>(Array::ContactX), pipeline.read<float>(Array::ContactY),
                            pipeline.read<float>(Array::ContactZ)};
    const auto velocity = pipeline.read<glm::vec4>(Array::Velocity, simulation.count());
    const auto unheld = pipeline.read<glm::vec4>(Array::UnheldVelocity, simulation.count());
    const std::uint32_t bundles = simulation.plan().grid.bundles();
    const std::uint32_t half = words[bundles * BUNDLE_WORDS + WORD_HALF];
    std::vector<glm::dvec3> held(simulation.count());
    std::vector<double> number(simulation.count());
    for (std::uint32_t bundle = 0; bundle < bundles; ++bundle) {
        const std::uint32_t first = words[bundle * BUNDLE_WORDS];
        for (std::uint32_t k = first; k < first + words[bundle * BUNDLE_WORDS + 1]; ++k) {
            if ((pairs[k].y & PAIR_REMEMBERS) == 0) continue;
            const glm::dvec3 impulse(memory[0][half + k], memory[1][half + k], memory[2][half + k]);
            const std::uint32_t a = pairs[k].x;
            const std::uint32_t b = SECOND_OF(pairs[k]);
            ASSERT_LT(b, simulation.count()) << "a pair that has ended remembers something";
            held[a] += impulse;
            held[b] -= impulse;
            ++number[a];
            ++number[b];
        }
    }
    for (std::uint32_t slot = 0; slot < simulation.count(); ++slot) {
        const auto parts = static_cast<double>(unheld[slot].w);
        EXPECT_EQ(std::floor(parts), number[slot])
            << "contacts of slot " << slot << " at " << simulation.time() << " s";
        if (parts != std::floor(parts)) continue;  // it touches a wall
        const auto inverseMass = static_cast<double>(std::abs(velocity[slot].w));
        const glm::dvec3 sum = held[slot] * inverseMass;
        EXPECT_LT(glm::length(glm::dvec3(velocity[slot] - unheld[slot]) - sum), 1e-4 + 1e-4 * glm::length(sum))
            << "slot " << slot << " at " << simulation.time() << " s";
    }
}

// Spheres fall on a sleeping bed, twice, and some of the bed are pushed and removed.
void expectCompleteListsUnderRain(sim::Simulation& simulation, std::uint64_t seed, float speed) {
    scene::Random random(seed, 7);
    ASSERT_TRUE(simulation.apply(spawnOf(rain(random, 12, speed))));
    std::uint32_t withMovers = 0;
    for (int k = 0; k < 480; ++k) {
        if (k % 100 == 50) {
            const std::uint64_t id = static_cast<std::uint64_t>(random.uniform(0, simulation.count()));
            ASSERT_TRUE(simulation.apply(sim::Push{.target = id, .impulse = {0.1, 0.05, 0.3}}));
        }
        if (k == 120) {
            ASSERT_TRUE(simulation.apply(spawnOf(rain(random, 6, speed))));
        }
        if (k == 320) {
            ASSERT_TRUE(simulation.apply(sim::Remove{.spheres = {5, 77, 2421, 2431, 2400}}));
        }
        ASSERT_TRUE(simulation.advance());
        const std::vector<std::uint32_t> counters = countersOf(simulation);
        ASSERT_EQ(counters[COUNTER_UNLISTED], 0U);
        withMovers += counters[COUNTER_MOVERS] > 0 ? 1 : 0;
        if (k % 4 != 0) continue;
        expectCompleteLists(simulation);
        expectHeldSums(simulation);
        if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(withMovers, 100U);
    EXPECT_EQ(simulation.statistics().nonFinite, 0U);
}

TEST(Movers, AreListedOnceWithAllTheyTouch) {
    for (const float speed : {1.0F, 2.0F, 8.0F}) {
        SCOPED_TRACE(speed);
        const auto seed = static_cast<std::uint64_t>(speed);
        expectCompleteListsUnderRain(*sleepingBed(seed), seed, speed);
    }
}

// Spheres meet at an open face, on both sides of it: a fountain from the bed goes through the face and falls back.
TEST(Movers, AreListedAtAnOpenFace) {
    for (const std::uint64_t seed : {11U, 12U}) {
        SCOPED_TRACE(seed);
        scene::Scene scene = bedOf(5, seed);
        scene.bounds.open[scene::ZMax] = true;
        scene.bounds.max.z = -0.3;
        const auto simulation = simulate(scene);
        run(*simulation, 3);
        ASSERT_GE(sleepers(simulation->snapshot()), simulation->count() * 9 / 10);
        scene::Random random(seed, 7);
        std::uint32_t beyond = 0;
        for (int k = 0; k < 480; ++k) {
            if (k % 8 == 0 && k < 320) {
                std::vector<scene::Sphere> spheres;
                for (int j = 0; j < 3; ++j) {
                    const glm::vec3 velocity(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                                             random.uniform(1, 5));
                    spheres.push_back(
                        {.position = {0.15 * j - 0.15 + random.uniform(-0.02, 0.02), random.uniform(-0.3, 0.3), -0.45},
                         .velocity = velocity,
                         .radius = radius});
                }
                // Refused if a sphere is still there.
                (void)simulation->apply(spawnOf(spheres));
            }
            ASSERT_TRUE(simulation->advance());
            if (k % 2 != 0) continue;
            beyond = std::max(beyond, simulation->statistics().outside);
            expectCompleteLists(*simulation);
            if (HasFailure()) return;
        }
        EXPECT_GT(beyond, 10U);
        EXPECT_GT(simulation->count(), 2420U + 40U);
    }
}

// One sphere that moves asks for lists of a few.
TEST(Movers, OneSphereAsksForNoListsOfAll) {
    for (const float speed : {0.0F, 3.0F, 20.0F}) {
        SCOPED_TRACE(speed);
        const auto simulation = sleepingBed(4);
        ASSERT_TRUE(
            simulation->apply(spawnOf({{.position = {0.1, 0.2, 1.1}, .velocity = {0, 0, -speed}, .radius = radius}})));
        const std::vector<std::uint32_t> before = countersOf(*simulation);
        run(*simulation, 1);
        const std::vector<std::uint32_t> after = countersOf(*simulation);
        const std::uint32_t rebuilds = after[COUNTER_REBUILDS] - before[COUNTER_REBUILDS];
        EXPECT_GT(rebuilds, 10U);
        // The lists of a mover last for several of the 480 substeps.
        EXPECT_LT(rebuilds, 200U);
        EXPECT_LE(after[COUNTER_LISTS] - before[COUNTER_LISTS], 2U);
    }
}

// One that leaves through an open face is far from all others after a while.
TEST(Movers, ASphereThatLeavesAsksForFewLists) {
    scene::Scene scene = bedOf(5, 5);
    scene.bounds.open[scene::ZMax] = true;
    const auto simulation = simulate(scene);
    run(*simulation, 3);
    ASSERT_TRUE(simulation->apply(spawnOf({{.position = {0.1, 0.2, 0.9}, .velocity = {0, 0, 60}, .radius = radius}})));
    run(*simulation, 1);
    const std::vector<std::uint32_t> before = countersOf(*simulation);
    run(*simulation, 2);
    const std::vector<std::uint32_t> after = countersOf(*simulation);
    EXPECT_EQ(simulation->statistics().outside, 1U);
    EXPECT_LE(after[COUNTER_REBUILDS] - before[COUNTER_REBUILDS], 20U);
}

// Movers that fall asleep join the others.
TEST(Movers, SleepAgain) {
    const auto simulation = sleepingBed(6);
    scene::Random random(6, 7);
    ASSERT_TRUE(simulation->apply(spawnOf(rain(random, 60, 2))));
    run(*simulation, 4);
    const sim::Statistics rest = simulation->statistics();
    EXPECT_GE(rest.sleeping, rest.spheres * 9 / 10);
    EXPECT_LT(rest.overlapMean, 0.006);
    EXPECT_EQ(rest.outside, 0U);
    // They wake without a jump.
    ASSERT_TRUE(simulation->apply(sim::Set{.gravity = simulation->scene().forces.gravity}));
    double fastest = 0;
    for (int k = 0; k < 48; ++k) {
        ASSERT_TRUE(simulation->advance());
        fastest = std::max(fastest, simulation->statistics().speedMax);
    }
    EXPECT_LT(fastest, 0.2);
}

}  // namespace
}  // namespace spherule::physics
