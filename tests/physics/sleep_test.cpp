#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

scene::Sphere at(glm::dvec3 position) {
    scene::Sphere sphere;
    sphere.position = position;
    sphere.radius = 0.05F;
    return sphere;
}

void push(sim::Simulation& simulation, std::uint32_t id, glm::dvec3 velocity) {
    const double mass = massOf(simulation.snapshot(), id);
    ASSERT_TRUE(simulation.apply(sim::Push{.target = id, .impulse = mass * velocity}));
}

// A column of balls, one exactly on top of the other, all asleep.
std::unique_ptr<sim::Simulation> sleepingColumn(int height) {
    scene::Scene scene = sleepyBox(2);
    scene.bounds.material = addMaterial(scene, {.restitution = 0});  // a sphere that is pushed away does not come back
    for (int k = 0; k < height; ++k) scene.spheres.push_back(at({0, 0, -0.95 + 0.1 * k}));
    auto simulation = simulate(scene);
    run(*simulation, 3);
    EXPECT_EQ(sleepers(simulation->snapshot()), simulation->count());
    return simulation;
}

TEST(Sleep, DoesNotStartAtTheTopOfAFlight) {
    for (const double g : {earth, 0.1, 0.01}) {
        SCOPED_TRACE(g);
        scene::Scene scene = sleepyBox(20);
        scene.forces.gravity = {0, 0, -g};
        scene.spheres.push_back(at({0, 0, 0}));
        const double up = g;  // at the top after one second
        scene.spheres[0].velocity = {0, 0, static_cast<float>(up)};
        const auto simulation = simulate(scene);
        for (int step = 0; step < 120; ++step) {
            run(*simulation, scene.step);
            ASSERT_EQ(sleepers(simulation->snapshot()), 0U) << "in step " << step;
        }
        EXPECT_NEAR(positionOf(simulation->snapshot(), 0).z, 0, 1e-4 * g);
    }
}

// The sphere moves by less than the move-away distance, and is slow at each apex. But it never is slow and supported at
// the same time.
TEST(Sleep, DoesNotStartForABouncingSphere) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.948})};
    setRestitution(scene, 1);
    const auto simulation = simulate(scene);
    for (int step = 0; step < 120; ++step) {
        run(*simulation, scene.step);
        ASSERT_EQ(sleepers(simulation->snapshot()), 0U) << "in step " << step;
    }
}

TEST(Sleep, EndsWhenATouchingSphereIsPushedSlowly) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.95}), at({0.1, 0, -0.95})};
    const auto simulation = simulate(scene);
    run(*simulation, 1.5);
    ASSERT_EQ(sleepers(simulation->snapshot()), 2U);
    push(*simulation, 0, {0.3, 0, 0});
    run(*simulation, simulation->scene().step);
    const sim::State state = simulation->snapshot();
    EXPECT_NEAR(velocityOf(state, 0).x + velocityOf(state, 1).x, 0.3, 1e-4) << "momentum has gone into a sleeper";
}

TEST(Sleep, EndsWhenASphereIsHit) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.95}), at({0.1, 0, -0.95}), at({-0.8, 0, -0.95})};
    const auto simulation = simulate(scene);
    run(*simulation, 1.5);
    ASSERT_EQ(sleepers(simulation->snapshot()), 3U);
    const sim::State before = simulation->snapshot();
    push(*simulation, 2, {3, 0, 0});
    run(*simulation, 0.5);
    const sim::State after = simulation->snapshot();
    EXPECT_GT(positionOf(after, 0).x, positionOf(before, 0).x + 0.01);
    EXPECT_GT(positionOf(after, 1).x, positionOf(before, 1).x + 0.1) << "the blow goes through the first to the second";
    EXPECT_FALSE(asleep(after, 1));
}

// Rows of sleepers in any direction and order, whose first one is hit. Within the substep of the blow, a sphere may
// come to a neighbour that still sleeps. The neighbour must not take the momentum as a wall does. (All blows are faster
// than the wake speed, up to which a sleeper does hold like a wall.)
TEST(Sleep, BlowThroughSleepersKeepsMomentum) {
    scene::Random random(5);
    for (int k = 0; k < 40; ++k) {
        SCOPED_TRACE(k);
        scene::Scene scene = sleepyBox(4);
        scene.quality.model = k % 2 == 0 ? scene::Model::Balanced : scene::Model::Fast;
        setRestitution(scene, random.uniform(0.6, 1));
        const double angle = random.uniform(0, 2 * std::numbers::pi);
        const glm::dvec3 along{std::cos(angle), std::sin(angle), 0};
        const int length = 2 + k % 3;
        const double place = random.uniform(-0.3, 0.3);
        const glm::dvec3 first = along * place - glm::dvec3(0, 0, 1.95);
        for (int n = 0; n < length; ++n) scene.spheres.push_back(at(first + 0.1 * n * along));
        scene.spheres.push_back(at(first - 0.3 * along));
        for (std::size_t n = 1; n < static_cast<std::size_t>(length); ++n)
            std::swap(scene.spheres[n], scene.spheres[static_cast<std::size_t>(random.uniform(0, n + 1.0))]);
        const auto simulation = simulate(scene);
        run(*simulation, 1.5);
        ASSERT_EQ(sleepers(simulation->snapshot()), simulation->count());
        const double speed = random.uniform(3, 5);
        push(*simulation, static_cast<std::uint32_t>(length), speed * along);
        const auto placeAlong = [&](const sim::State& state, std::uint32_t id) {
            return glm::dot(positionOf(state, id), along);
        };
        const sim::State before = simulation->snapshot();
        for (double time = 0; time < 0.2 / speed + 0.1; time += scene.step) {
            run(*simulation, scene.step);
            double momentum = 0;  // over the mass of a sphere (m/s)
            double energy = 0;    // twice the energy over that mass (m^2/s^2)
            const sim::State state = simulation->snapshot();
            for (std::uint32_t id = 0; id < state.count(); ++id) {
                momentum += glm::dot(velocityOf(state, id), along);
                energy += glm::dot(velocityOf(state, id), velocityOf(state, id));
                for (std::uint32_t other = 0; other < id; ++other)
                    ASSERT_EQ(placeAlong(state, id) < placeAlong(state, other),
                              placeAlong(before, id) < placeAlong(before, other))
                        << "spheres have passed each other";
            }
            ASSERT_NEAR(momentum, speed, 1e-3 * speed) << "after " << time << " s";
            ASSERT_LE(energy, 1.001 * speed * speed);
        }
        const sim::State after = simulation->snapshot();
        for (std::uint32_t id = 0; id < after.count(); ++id)
            EXPECT_GT(placeAlong(after, id), placeAlong(before, id)) << "the blow has not reached sphere " << id;
    }
}

TEST(Sleep, EndsWhenASlowSphereArrives) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.95}), at({-0.3, 0, -0.95})};
    const auto simulation = simulate(scene);
    run(*simulation, 1.5);
    ASSERT_EQ(sleepers(simulation->snapshot()), 2U);
    push(*simulation, 1, {0.2, 0, 0});
    run(*simulation, 1.5);
    const sim::State state = simulation->snapshot();
    EXPECT_NEAR(velocityOf(state, 0).x + velocityOf(state, 1).x, 0.2, 0.002) << "momentum has gone into a sleeper";
}

TEST(Sleep, EndsWhenTheSupportIsRemoved) {
    const auto simulation = sleepingColumn(4);
    push(*simulation, 0, {4, 0, 0});
    run(*simulation, 1);
    const sim::State state = simulation->snapshot();
    EXPECT_LT(positionOf(state, 1).z, -0.85 - 0.04);
    for (std::uint32_t id = 1; id < 4; ++id) EXPECT_LT(positionOf(state, id).z, -0.95 + 0.1 * id - 0.04) << id;
}

TEST(Sleep, EndsWhenTheSupportLeavesWithinASubstep) {
    const auto simulation = sleepingColumn(4);
    push(*simulation, 0, {40, 0, 0});  // 83 mm a substep
    run(*simulation, 0.08);
    EXPECT_LT(positionOf(simulation->snapshot(), 1).z, -0.95 + 0.1 - 0.025) << "it falls from the first substep on";
    // Each other sphere falls when its support has sunk by the move-away distance (5 mm), after 32 ms.
    run(*simulation, 0.05);
    const sim::State state = simulation->snapshot();
    for (std::uint32_t id = 2; id < 4; ++id) EXPECT_LT(positionOf(state, id).z, -0.95 + 0.1 * id - 0.01) << id;
}

TEST(Sleep, EndsWhenTheSupportMovesAwaySlowly) {
    const auto simulation = sleepingColumn(2);
    push(*simulation, 0, {0.025, 0, 0});
    run(*simulation, 5);
    EXPECT_LT(positionOf(simulation->snapshot(), 1).z, -0.95 + 0.01) << "nothing holds it up there";
}

// A fast sphere causes a rebuild of the lists in every substep, before a slow sphere has moved by the margin.
TEST(Sleep, EndsWhenTheSupportMovesSlowlyDuringFrequentRebuilds) {
    scene::Scene scene = sleepyBox(2);
    scene.spheres = {at({0, 0, -0.95}), at({0, 0, -0.85}), at({0.9, 0.9, 0.9})};
    scene.spheres[2].radius = 0.025F;
    scene.bounds.material = addMaterial(scene, {.restitution = 1});
    scene.spheres[2].material = scene.bounds.material;
    scene.spheres[2].velocity = {0, 0, -15};
    const auto simulation = simulate(scene);
    run(*simulation, 3);
    ASSERT_TRUE(asleep(simulation->snapshot(), 0) && asleep(simulation->snapshot(), 1));
    push(*simulation, 0, {0.025, 0, 0});
    const auto rebuilds = simulation->counters().rebuilds;
    run(*simulation, 5);
    EXPECT_GT(simulation->counters().rebuilds, rebuilds + 2000) << "the world is not busy";
    EXPECT_LT(positionOf(simulation->snapshot(), 1).z, -0.95 + 0.01) << "nothing holds it up there";
}

TEST(Sleep, EndsWhenGravityChanges) {
    const auto simulation = sleepingColumn(3);
    ASSERT_TRUE(simulation->apply(sim::Set{.gravity = glm::dvec3(0, 0, 2)}));
    run(*simulation, 0.5);
    const sim::State state = simulation->snapshot();
    for (std::uint32_t id = 0; id < 3; ++id) {
        EXPECT_FALSE(asleep(state, id));
        EXPECT_GT(positionOf(state, id).z, -0.95 + 0.1 * id + 0.2);
    }
}

constexpr double watched = 2;  // s for which a sleeping sphere must not move

// Checks every sphere after every step. A sphere that falls asleep must have been slower than the threshold over the
// sleep time. The position of a sleeping sphere must not change by a bit.
class Watch {
  public:
    explicit Watch(const scene::Scene& scene)
        : farthest_(scene.sleep.speed * scene.sleep.time),
          quietSteps_(static_cast<std::size_t>(scene.sleep.time / scene.step) - 1),
          watchedSteps_(static_cast<int>(std::lround(watched / scene.step))),
          spheres_(scene.spheres.size()) {}

    void look(const sim::State& state) {
        for (std::uint32_t id = 0; id < state.count(); ++id) {
            if (asleep(state, id)) {
                lookAtSleeper(state, id);
            } else {
                spheres_[id].asleepFor = 0;
            }
            auto& places = spheres_[id].places;
            places.push_back(positionOf(state, id));
            if (places.size() > quietSteps_) places.pop_front();
        }
    }

    int fellAsleep = 0;
    int tooFast = 0;
    int moved = 0;
    int sleptLong = 0;  // spheres that slept for all of the watched time

  private:
    struct Seen {
        std::deque<glm::dvec3> places{};  // of the last steps
        int asleepFor = 0;                // steps
        glm::dvec3 place{};
    };

    void lookAtSleeper(const sim::State& state, std::uint32_t id) {
        Seen& seen = spheres_[id];
        if (seen.asleepFor++ == 0) {
            ++fellAsleep;
            seen.place = positionOf(state, id);
            if (seen.places.size() < quietSteps_ || glm::distance(seen.places.front(), seen.place) > farthest_)
                ++tooFast;
        }
        if (positionOf(state, id) != seen.place || velocityOf(state, id) != glm::dvec3(0)) ++moved;
        if (seen.asleepFor == watchedSteps_) ++sleptLong;
    }

    double farthest_;  // m
    std::size_t quietSteps_;
    int watchedSteps_;
    std::vector<Seen> spheres_;
};

Watch watch(sim::Simulation& simulation, double seconds) {
    Watch watch(simulation.scene());
    const auto steps = std::lround(seconds / simulation.scene().step);
    for (long k = 0; k < steps; ++k) {
        run(simulation, simulation.scene().step);
        watch.look(simulation.snapshot());
    }
    return watch;
}

// 100 balls fall on the floor one by one, and 20 more on top of some of them.
TEST(SleepWatch, BallsOnTheFloorFallAsleepAndDoNotMove) {
    scene::Scene scene = sleepyBox(2);
    scene::Sphere ball;
    ball.radius = 0.05F;
    for (int k = 0; k < 100; ++k) {
        ball.position = {0.17 * (k % 10 - 4.5), 0.17 * (k / 10 - 4.5), -0.94 + 0.002 * k};
        scene.spheres.push_back(ball);
    }
    for (std::size_t k = 0; k < 20; ++k) {
        ball.position = scene.spheres[k].position + glm::dvec3(0, 0, 0.3);
        scene.spheres.push_back(ball);
    }
    const auto simulation = simulate(scene);
    const Watch seen = watch(*simulation, 4);
    EXPECT_EQ(seen.tooFast, 0);
    EXPECT_EQ(seen.moved, 0);
    EXPECT_GE(seen.fellAsleep, 120);
    EXPECT_EQ(seen.sleptLong, 120);
    EXPECT_EQ(simulation->statistics().sleeping, 120U);
}

TEST(SleepWatch, OnlySlowSpheresOfABedSleepAndTheyDoNotMove) {
    const auto simulation = simulate(named("box-4k"));
    const Watch seen = watch(*simulation, 5);
    EXPECT_EQ(seen.tooFast, 0);
    EXPECT_EQ(seen.moved, 0);
    EXPECT_GT(sleepers(simulation->snapshot()), 3800U) << "of 4,000";
    const sim::State state = simulation->snapshot();
    EXPECT_EQ(simulation->statistics().sleeping, sleepers(state));
    RecordProperty("asleepPercent", std::to_string(100.0 * sleepers(state) / state.count()));
    RecordProperty("fellAsleep", seen.fellAsleep);
    RecordProperty("sleptForTwoSeconds", seen.sleptLong);
}

}  // namespace
}  // namespace spherule::physics
