#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <glm/geometric.hpp>

#include "support.h"

namespace spherule::physics {
namespace {

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
TEST(SleepWatch, BallsOnTheFloorAllFallAsleepAndStayExactlyWhereTheyAre) {
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

TEST(SleepWatch, InABedNothingFastFallsAsleepAndNoSleeperMoves) {
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
