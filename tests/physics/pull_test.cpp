// Springs between spheres and points, in each model, against exact solutions in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr double radius = 0.05;  // m
constexpr double rate = 10;      // 1/s: of a spring without a stiffness
const double mass = 4.0 / 3 * std::numbers::pi * radius * radius * radius * 1000;
constexpr scene::Model models[] = {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate};

glm::dvec3 randomDirection(scene::Random& random) {
    return glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
}

// A sphere at rest at `place`, in space around `centre`. A step is one substep of `step` seconds, or of an eighth of it
// in `accurate`, which needs short ones.
scene::Scene oneSphere(scene::Model model, glm::dvec3 centre, glm::dvec3 place, double step = 1.0 / 480) {
    scene::Scene scene = fineStepSpace(4);
    scene.bounds.min += centre;
    scene.bounds.max += centre;
    scene.step = model == scene::Model::Accurate ? step / 8 : step;
    scene.quality.model = model;
    scene.spheres = {{.position = centre + place, .radius = static_cast<float>(radius)}};
    return scene;
}

class Pulls : public testing::TestWithParam<scene::Model> {
  public:
    static int seeds() { return GetParam() == scene::Model::Accurate ? 1 : 3; }  // it takes eight times the steps
    static glm::dvec3 pull(sim::Simulation& simulation, const sim::Pull& pull) {
        const auto applied = simulation.apply(pull);
        if (!applied) throw std::runtime_error(applied.error().text());
        return applied->force.value();
    }
};

// From rest at the distance d, the sphere is at d (1 + w t) exp(-w t).
TEST_P(Pulls, FreeSpheresFollowTheCriticallyDampedSolution) {
    scene::Random random(5);
    for (int seed = 0; seed < seeds(); ++seed) {
        const glm::dvec3 centre = 20.0 * randomDirection(random);
        const glm::dvec3 way = 0.06 * randomDirection(random);
        double before = 1;
        for (const double step : {1.0 / 480, 1.0 / 1920}) {
            const auto simulation = simulate(oneSphere(GetParam(), centre, -way, step));
            const glm::dvec3 force = pull(*simulation, {.session = 1, .sphere = 0, .point = centre});
            EXPECT_LT(glm::length(force - mass * rate * rate * way), 3 * rate * step * glm::length(force));
            double worst = 0;
            for (int k = 1; k <= 40; ++k) {
                run(*simulation, 1.0 / 60);
                const double wt = rate * k / 60;
                const glm::dvec3 expected = -way * ((1 + wt) * std::exp(-wt));
                worst = std::max(worst, glm::length(positionOf(simulation->snapshot(), 0) - expected));
            }
            EXPECT_LT(worst, 0.5 * rate * step * glm::length(way)) << "steps of " << step;
            EXPECT_LT(worst, 0.4 * before) << "shrinks with the substep";
            before = worst;
        }
    }
}

TEST_P(Pulls, HangingSpheresSagByTheirWeight) {
    scene::Random random(2);
    for (int seed = 0; seed < seeds(); ++seed) {
        const glm::dvec3 centre = 20.0 * randomDirection(random);
        scene::Scene scene = oneSphere(GetParam(), centre, {});
        scene.forces.gravity = earth * randomDirection(random);
        const double stiffness = mass * 900;
        const auto simulation = simulate(scene);
        const sim::Pull spring{.session = 1, .sphere = 0, .point = centre, .stiffness = stiffness};
        pull(*simulation, spring);
        run(*simulation, 2);
        const glm::dvec3 sag = mass * scene.forces.gravity / stiffness;
        EXPECT_LT(glm::length(positionOf(simulation->snapshot(), 0) - sag), 0.01 * glm::length(sag));
        const glm::dvec3 force = pull(*simulation, spring);
        EXPECT_LT(glm::length(force + mass * scene.forces.gravity), 0.01 * glm::length(force));
    }
}

// The stiffness stays as it was asked for when the sphere gets another mass.
TEST_P(Pulls, KeepTheirStiffnessWhenTheMassChanges) {
    scene::Scene scene = oneSphere(GetParam(), {}, {});
    scene.forces.gravity = {0, 0, -9.81};
    const auto simulation = simulate(scene);
    const double stiffness = mass * 900;
    (void)pull(*simulation, {.session = 1, .sphere = 0, .point = {}, .stiffness = stiffness});
    for (const double density : {1000.0, 500.0, 1500.0}) {
        const auto changed = simulation->apply(sim::ChangePart{.make = [density](scene::Scene& all) {
            all.materials[0].density = density;
            return Result<scene::PartChange>({scene::PartChange::Part::Materials, scene::PartChange::Kind::Changed, 0});
        }});
        ASSERT_TRUE(changed) << changed.error().text();
        run(*simulation, 2);
        const double sag = -sim::positionOf(simulation->snapshot(), 0).z;
        const double expected = mass * density / 1000 * 9.81 / stiffness;
        EXPECT_NEAR(sag, expected, 0.01 * expected) << density;
    }
}

TEST_P(Pulls, GivesTheMomentumOfTheForceThatItReports) {
    scene::Random random(9);
    for (int seed = 0; seed < seeds(); ++seed) {
        const glm::dvec3 way = 0.05 * randomDirection(random);
        const auto simulation = simulate(oneSphere(GetParam(), {}, -way, 1.0 / 1920));
        const double step = simulation->scene().step;
        glm::dvec3 given{};
        for (int k = 0; k < std::lround(0.1 / step); ++k) {
            given += step * pull(*simulation, {.session = 1, .sphere = 0, .point = {}});
            run(*simulation, step);
        }
        const glm::dvec3 momentum = mass * velocityOf(simulation->snapshot(), 0);
        EXPECT_LT(glm::length(momentum - given), 1e-3 * glm::length(momentum));
    }
}

// Pushes and pulls give spheres on a smooth floor, one or two on each other, their momentum once: the contacts go on to
// hold the weight alone.
TEST(PullsInBalanced, LeaveTheHeldImpulsesOfRestingSpheres) {
    for (const std::uint32_t count : {1U, 2U}) {
        scene::Scene scene = fineStepBox(2);
        scene.step = 1.0 / 1920;
        scene.quality.model = scene::Model::Balanced;
        setRestitution(scene, 0.3);
        const auto height = [](std::uint32_t id) { return -1 + radius * (2 * id + 1); };
        for (std::uint32_t id = 0; id < count; ++id) measure::addSphere(scene, {0, 0, height(id)}, radius);
        const auto simulation = simulate(scene);
        run(*simulation, 0.5);
        const auto velocity = [&](std::uint32_t id) { return velocityOf(simulation->snapshot(), id); };
        for (std::uint32_t id = 0; id < count; ++id) {
            ASSERT_LT(glm::length(velocity(id)), 2e-3);
            ASSERT_TRUE(simulation->apply(sim::Push{.target = id, .impulse = mass * glm::dvec3(0.3, 0.1, 0)}));
        }
        for (int k = 0; k < 10; ++k) {
            run(*simulation, scene.step);
            for (std::uint32_t id = 0; id < count; ++id)
                EXPECT_LT(glm::length(velocity(id) - glm::dvec3(0.3, 0.1, 0)), 2e-3) << "substep " << k;
        }
        std::vector<glm::dvec3> momentum;
        for (std::uint32_t id = 0; id < count; ++id) momentum.push_back(mass * velocity(id));
        for (int k = 0; k < 100; ++k) {
            for (std::uint32_t id = 0; id < count; ++id)
                momentum[id] +=
                    scene.step *
                    Pulls::pull(*simulation, {.session = id + 1, .sphere = id, .point = {0.4, 0, height(id)}});
            run(*simulation, scene.step);
        }
        for (std::uint32_t id = 0; id < count; ++id)
            EXPECT_LT(glm::length(mass * velocity(id) - momentum[id]), 0.01 * glm::length(momentum[id])) << count;
    }
}

TEST_P(Pulls, EndWithReleaseAndMoveWithTheSession) {
    scene::Scene scene = oneSphere(GetParam(), {}, {-0.5, 0, 0});
    scene.spheres.push_back({.position = {0.5, 0, 0}, .radius = static_cast<float>(radius)});
    const auto simulation = simulate(scene);
    const auto speeds = [&] {
        const sim::State state = simulation->snapshot();
        return glm::dvec2(glm::length(velocityOf(state, 0)), glm::length(velocityOf(state, 1)));
    };
    pull(*simulation, {.session = 1, .sphere = 0, .point = {-0.5, 0.1, 0}});
    run(*simulation, 0.05);
    EXPECT_GT(speeds().x, 0.1);
    EXPECT_EQ(speeds().y, 0);
    ASSERT_TRUE(simulation->apply(sim::Release{.session = 2}));
    EXPECT_TRUE(simulation->pulling()) << "another session's";
    // The next pull of the session is its only one. The first sphere keeps its velocity.
    pull(*simulation, {.session = 1, .sphere = 1, .point = {0.5, 0.1, 0}});
    const double kept = speeds().x;
    run(*simulation, 0.05);
    EXPECT_NEAR(speeds().x, kept, 1e-6 * kept);
    EXPECT_GT(speeds().y, 0.1);
    ASSERT_TRUE(simulation->apply(sim::Release{.session = 1}));
    EXPECT_FALSE(simulation->pulling());
    const double released = speeds().y;
    run(*simulation, 0.5);
    EXPECT_NEAR(speeds().y, released, 1e-6 * released);
}

TEST_P(Pulls, EndWithTheSphereAndWithReset) {
    scene::Scene scene = oneSphere(GetParam(), {}, {-0.5, 0, 0});
    scene.spheres.push_back({.position = {0.5, 0, 0}, .radius = static_cast<float>(radius)});
    scene.groups = {{.name = "both", .count = 2, .look = {}}};
    const auto simulation = simulate(scene);
    pull(*simulation, {.session = 1, .sphere = 0, .point = {}});
    pull(*simulation, {.session = 2, .sphere = 1, .point = {0.5, 0.1, 0}});
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {0}}));
    run(*simulation, 0.05);
    EXPECT_GT(velocityOf(simulation->snapshot(), 0).y, 0.1) << "the other pull goes on";
    EXPECT_TRUE(simulation->pulling());
    // It goes on with other settings, too.
    ASSERT_TRUE(simulation->apply(
        sim::Set{.model = GetParam() == scene::Model::Fast ? scene::Model::Balanced : scene::Model::Fast}));
    EXPECT_TRUE(simulation->pulling());
    run(*simulation, 1);
    EXPECT_NEAR(positionOf(simulation->snapshot(), 0).y, 0.1, 1e-3);
    ASSERT_TRUE(simulation->apply(sim::Reset{}));
    EXPECT_FALSE(simulation->pulling());
    run(*simulation, 0.1);
    EXPECT_EQ(velocityOf(simulation->snapshot(), 1), glm::dvec3(0));
}

// The stiffest spring to the farthest point neither raises the substeps nor drives the sphere through a wall.
TEST_P(Pulls, HaveLimits) {
    scene::Scene scene = sleepyBox(1);
    scene.quality.model = GetParam();
    scene.quality.substepsFixed = false;
    scene.spheres = {{.position = {0, 0, 0}, .radius = static_cast<float>(radius)}};
    ASSERT_TRUE(scene::fitSubsteps(scene));
    const bool soft = GetParam() == scene::Model::Accurate;  // takes many substeps
    for (const double stiffness : {1e2, 1e4, 0.999e6}) {
        if (soft && stiffness == 1e4) continue;
        const auto simulation = simulate(scene);
        pull(*simulation, {.session = 1, .sphere = 0, .point = {1e9, 0, 0}, .stiffness = mass * stiffness});
        double fastest = 0;
        for (int k = 0; k < (soft ? 20 : 120); ++k) {
            run(*simulation, scene.step);
            EXPECT_EQ(simulation->substeps(), scene.quality.substeps);
            fastest = std::max(fastest, glm::length(velocityOf(simulation->snapshot(), 0)));
        }
        const sim::State state = simulation->snapshot();
        ASSERT_TRUE(allFinite(state));
        EXPECT_LE(fastest, scene::safeMotion * radius * scene.quality.substeps / scene.step);
        const double atWall = 0.5 * (scene.bounds.max.x - scene.bounds.min.x) - radius;
        EXPECT_LT(positionOf(state, 0).x, atWall + 0.5 * radius) << stiffness;
        if (stiffness < 1e4) {
            EXPECT_GT(positionOf(state, 0).x, atWall - 0.5 * radius);
        }
    }
}

TEST_P(Pulls, TakeTheNearestImageOnPeriodicAxes) {
    scene::Scene scene = oneSphere(GetParam(), {}, {1.9, 0, 0});
    scene.bounds.periodic = {true, false, false};
    scene.bounds.open = {false, false, true, true, true, true};
    const auto simulation = simulate(scene);
    const glm::dvec3 force = pull(*simulation, {.session = 1, .sphere = 0, .point = {-1.95, 0, 0}});
    EXPECT_NEAR(force.x, mass * rate * rate * 0.15, 0.5) << "to the other side it would be -198 N";
    run(*simulation, 2);
    EXPECT_NEAR(positionOf(simulation->snapshot(), 0).x, -1.95, 1e-3);
}

TEST_P(Pulls, RefuseWhatCannotBe) {
    scene::Scene scene = oneSphere(GetParam(), {}, {});
    scene.spheres.push_back({.position = {1, 0, 0}, .radius = static_cast<float>(radius), .fixed = true});
    const auto simulation = simulate(scene);
    const auto refused = [&](const sim::Pull& pull) {
        const auto applied = simulation->apply(pull);
        return applied ? Error{} : applied.error();
    };
    EXPECT_EQ(refused({.session = 1, .sphere = 1}).cause, Cause::FixedSphere);
    EXPECT_EQ(refused({.session = 1, .sphere = 2}).cause, Cause::NoSuchSphere);
    EXPECT_EQ(refused({.session = 1, .sphere = 0, .point = {2e9, 0, 0}}).where, "point");
    for (const double wrong : {0.0, -1.0, 1e9, std::nan("")})
        EXPECT_EQ(refused({.session = 1, .sphere = 0, .stiffness = wrong}).where, "stiffness") << wrong;
    EXPECT_FALSE(simulation->pulling());
    for (std::uint64_t session = 0; session < 64; ++session) pull(*simulation, {.session = session, .sphere = 0});
    EXPECT_EQ(refused({.session = 64, .sphere = 0}).cause, Cause::NoRoom);
    pull(*simulation, {.session = 63, .sphere = 0});
}

INSTANTIATE_TEST_SUITE_P(Of, Pulls, testing::ValuesIn(models),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

TEST(PulledSleepers, WakeAndStayAwake) {
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced}) {
        scene::Scene scene = sleepyBox(1);
        scene.quality.model = model;
        scene.materials[0].friction = 0.3;
        scene.spheres = {{.position = {0, 0, -0.45}, .radius = static_cast<float>(radius)}};
        const auto simulation = simulate(scene);
        run(*simulation, 3);
        ASSERT_TRUE(asleep(simulation->snapshot(), 0)) << scene::nameOf(model);
        ASSERT_TRUE(simulation->apply(sim::Pull{.session = 1, .sphere = 0, .point = {0, 0, -0.2}}));
        for (int k = 0; k < 20; ++k) {
            run(*simulation, 0.1);
            EXPECT_FALSE(asleep(simulation->snapshot(), 0)) << scene::nameOf(model);
        }
        EXPECT_NEAR(positionOf(simulation->snapshot(), 0).z, -0.2 - earth / (rate * rate), 2e-3);
    }
}

// Scenes in which nothing is pulled have no arrays for it.
TEST(PulledSleepers, CostNothingBeforeTheFirstPull) {
    const auto simulation = simulate(oneSphere(scene::Model::Balanced, {}, {}));
    EXPECT_FALSE(simulation->plan().has(sim::Array::Pulls));
    ASSERT_TRUE(simulation->apply(sim::Pull{.session = 1, .sphere = 0}));
    EXPECT_TRUE(simulation->plan().has(sim::Array::Pulls));
}

}  // namespace
}  // namespace spherule::physics
