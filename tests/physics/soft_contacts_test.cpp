// Contacts of the model `accurate`: compared with an integration of the same law in double, and checked for conserved
// quantities. There is no sleep and no gravity. Each test runs with several seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/stiffness.h"
#include "soft_reference.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr int phases = 25;      // instants within a substep at which the contact begins
constexpr double approach = 3;  // substeps

struct Setting {
    bool hertz = false;
    bool walls = false;
    double friction = 0;
};

class ObliqueImpact : public testing::TestWithParam<Setting> {};

scene::Scene soft(const Setting& setting, double restitution) {
    scene::Scene scene = fineStepSpace(2);
    scene.step = 1e-3;
    scene.materials = {{.density = 1000, .restitution = restitution, .friction = setting.friction},
                       {.name = "other", .density = 2500, .restitution = restitution, .friction = setting.friction}};
    if (setting.hertz) {
        scene.materials[0].young = 1e7;
        scene.materials[1].young = 3e7;
        scene.materials[1].poisson = 0.4;
    }
    scene.quality = {.model = scene::Model::Accurate, .substepsFixed = false, .overlap = 0.05};
    scene.sphereContacts = !setting.walls;
    scene.bounds.min.x = -4;
    scene.bounds.max.x = 4;
    if (setting.walls) scene.bounds.open[scene::ZMin] = false;
    return scene;
}

// Returns a random velocity at 20 to 80 degrees to -z.
glm::dvec3 obliquely(scene::Random& random) {
    const double angle = random.uniform(20, 80) * std::numbers::pi / 180;
    const double about = random.uniform(0, 2 * std::numbers::pi);
    const double speed = random.uniform(0.8, 1.2);
    return speed * glm::dvec3(std::sin(angle) * std::cos(about), std::sin(angle) * std::sin(about), -std::cos(angle));
}

reference::SoftBody bodyOf(const sim::State& state, std::uint32_t id) {
    return {positionOf(state, id), velocityOf(state, id), glm::dvec3(glm::vec3(state.spin[id])),
            static_cast<double>(state.position[id].w), 1 / massOf(state, id)};
}

reference::SoftLaw lawOf(const scene::Scene& scene, std::uint8_t a, std::uint8_t b, double friction) {
    const scene::Stiffness stiffness = scene::stiffnessBetween(scene, a, b, scene::springModulus(scene));
    return {scene::followsHertz(scene), stiffness.normal, stiffness.tangential, stiffness.damping, friction};
}

// Places rows of pairs, or of spheres above the floor. The contacts of a row are equal, except that they begin at
// different instants within a substep.
void place(scene::Scene& scene, scene::Random& random, bool walls, int rows) {
    for (int row = 0; row < rows; ++row) {
        const glm::vec3 v(obliquely(random));
        const auto r = static_cast<float>(random.uniform(0.04, 0.06));
        const auto other = static_cast<float>(random.uniform(0.04, 0.06));
        for (int k = 0; k < phases; ++k) {
            const glm::dvec3 at(0.3 * (k - phases / 2), 0.4 * (row - rows / 2), 0);
            scene.spheres.push_back({.position = at, .velocity = v, .radius = r});
            if (!walls) scene.spheres.push_back({.position = at, .radius = other, .material = 1});
        }
    }
}

void setHeights(scene::Scene& scene, bool walls) {
    const double h = scene.step / scene.quality.substeps;
    for (std::size_t k = 0; k < scene.spheres.size(); k += walls ? 1 : 2) {
        scene::Sphere& sphere = scene.spheres[k];
        const double phase = (static_cast<double>(k / (walls ? 1 : 2) % phases) + 0.5) / phases;
        const double gap = -static_cast<double>(sphere.velocity.z) * h * (approach + phase);
        sphere.position.z = walls ? scene.bounds.min.z + static_cast<double>(sphere.radius) + gap
                                  : static_cast<double>(sphere.radius + scene.spheres[k + 1].radius) + gap;
    }
}

TEST_P(ObliqueImpact, RotationMatchesTheContactLawForAnyPhase) {
    constexpr double ofReference = 0.01;
    constexpr double overPhases = 0.005;
    constexpr int rows = 4;
    double worst = 0;
    double widest = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        for (const double e : {0.7, 0.9}) {
            const bool walls = GetParam().walls;
            const double friction = GetParam().friction;
            scene::Random random(seed);
            scene::Scene scene = soft(GetParam(), e);
            place(scene, random, walls, rows);
            ASSERT_TRUE(scene::fitSubsteps(scene));
            setHeights(scene, walls);
            const auto simulation = simulate(scene);
            const sim::State start = simulation->snapshot();
            const double floor = -0.5 * (scene.bounds.max.z - scene.bounds.min.z);
            // Contacts of the slower take longer.
            run(*simulation, 2.5 * scene::contactTimeOf(scene).contact + scene.step);
            const sim::State end = simulation->snapshot();
            const std::uint32_t each = walls ? 1 : 2;
            for (std::uint32_t row = 0; row < rows; ++row) {
                const std::uint32_t first = row * phases * each;
                reference::SoftBody a = bodyOf(start, first);
                reference::SoftBody b = bodyOf(start, first + each - 1);
                if (walls) {
                    a.x.z -= floor;
                    meetFloor(a, lawOf(scene, 0, 0, friction));
                } else {
                    meet(a, b, lawOf(scene, 0, 1, friction));
                }
                const double expected = a.rotationalEnergy() + (walls ? 0 : b.rotationalEnergy());
                double least = 1e30;
                double most = 0;
                for (std::uint32_t id = first; id < first + phases * each; id += each) {
                    double got = bodyOf(end, id).rotationalEnergy();
                    if (!walls) got += bodyOf(end, id + 1).rotationalEnergy();
                    least = std::min(least, got / expected);
                    most = std::max(most, got / expected);
                }
                SCOPED_TRACE(testing::Message() << "seed " << seed << ", e = " << e << ", row " << row << ", velocity "
                                                << start.velocity[first].x << " " << start.velocity[first].y << " "
                                                << start.velocity[first].z);
                EXPECT_GT(least, 1 - ofReference);
                EXPECT_LT(most, 1 + ofReference);
                EXPECT_LT(most - least, overPhases);
                worst = std::max({worst, std::abs(least - 1), std::abs(most - 1)});
                widest = std::max(widest, most - least);
            }
        }
    }
    RecordProperty("worst", std::to_string(worst));
    RecordProperty("overPhases", std::to_string(widest));
}

std::vector<Setting> settings() {
    std::vector<Setting> all;
    for (const bool hertz : {false, true})
        for (const bool walls : {false, true})
            for (const double friction : {0.2, 0.4, 0.6, 0.8}) all.push_back({hertz, walls, friction});
    return all;
}

INSTANTIATE_TEST_SUITE_P(Of, ObliqueImpact, testing::ValuesIn(settings()), [](const auto& parameter) {
    const Setting& of = parameter.param;
    return std::string(of.hertz ? "Hertz" : "Linear") + (of.walls ? "Wall" : "Pair") +
           std::to_string(std::lround(10 * of.friction));
});

// Pairs of spinning spheres that collide obliquely, far from other pairs. Radii, masses, speeds and directions are
// random.
scene::Scene meetings(std::uint64_t seed, const Setting& setting, double restitution, int count = 40) {
    scene::Random random(seed);
    scene::Scene scene = soft(setting, restitution);
    scene.bounds.min = glm::dvec3(-1.5);
    scene.bounds.max = glm::dvec3(1.5);
    const auto anything = [&random](double size) {
        const double x = random.uniform(-size, size);
        const double y = random.uniform(-size, size);
        return glm::dvec3(x, y, random.uniform(-size, size));
    };
    for (int k = 0; k < count; ++k) {
        const glm::dvec3 at = 0.4 * glm::dvec3(k % 5 - 2, k / 5 % 5 - 2, k / 25);
        const glm::dvec3 n = glm::normalize(anything(1) + glm::dvec3(0, 0, 1e-3));
        const glm::dvec3 v = anything(1);
        const glm::dvec3 closing = v - n * (glm::dot(v, n) + random.uniform(0.3, 1));
        scene::Sphere a{.radius = static_cast<float>(random.uniform(0.03, 0.06)), .spin = glm::vec3(anything(10))};
        scene::Sphere b{.radius = static_cast<float>(random.uniform(0.03, 0.06)), .material = 1};
        b.spin = glm::vec3(anything(10));
        a.velocity = glm::vec3(0.5 * closing);
        b.velocity = glm::vec3(-0.5 * closing);
        const double apart = static_cast<double>(a.radius + b.radius) + random.uniform(1e-4, 1e-3);
        a.position = at + n * (0.5 * apart);
        b.position = at - n * (0.5 * apart);
        scene.spheres.push_back(a);
        scene.spheres.push_back(b);
    }
    return scene;
}

constexpr double longEnough = 0.05;  // s after which all pairs have separated

// Returns the rotational energy (J) of each pair at the end.
std::vector<double> rotationsAfter(scene::Scene scene, double seconds = longEnough) {
    EXPECT_TRUE(scene::fitSubsteps(scene));
    const auto simulation = simulate(std::move(scene));
    run(*simulation, seconds);
    const sim::State end = simulation->snapshot();
    std::vector<double> energies;
    for (std::uint32_t id = 0; id < end.count(); id += 2)
        energies.push_back(bodyOf(end, id).rotationalEnergy() + bodyOf(end, id + 1).rotationalEnergy());
    return energies;
}

void expectTheSame(const std::vector<double>& got, const std::vector<double>& expected, double tolerance,
                   double factor = 1) {
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t k = 0; k < got.size(); ++k)
        EXPECT_NEAR(got[k] / factor, expected[k], tolerance * expected[k]) << "pair " << k;
}

class SoftContacts : public testing::TestWithParam<bool> {
  protected:
    static Setting setting() { return {.hertz = GetParam(), .walls = false, .friction = 0.4}; }
};

TEST_P(SoftContacts, AreTheSameInAMovingFrame) {
    for (const std::uint64_t seed : {1U, 2U}) {
        const scene::Scene still = meetings(seed, setting(), 0.7);
        scene::Scene moving = still;
        for (scene::Sphere& sphere : moving.spheres) sphere.velocity += glm::vec3(10, -5, 3);
        EXPECT_EQ(scene::substepsFor(moving, scene::Model::Accurate).value(),
                  scene::substepsFor(still, scene::Model::Accurate).value());
        expectTheSame(rotationsAfter(moving), rotationsAfter(still), 0.003);
    }
}

TEST_P(SoftContacts, AreTheSameAfterRotationOfTheScene) {
    const scene::Scene scene = meetings(3, setting(), 0.7);
    scene::Scene rotated = scene;
    const auto turned = [](const auto& v) { return std::decay_t<decltype(v)>(v.y, v.z, v.x); };
    for (scene::Sphere& sphere : rotated.spheres) {
        sphere.position = turned(sphere.position);
        sphere.velocity = turned(sphere.velocity);
        sphere.spin = turned(sphere.spin);
    }
    expectTheSame(rotationsAfter(rotated), rotationsAfter(scene), 0.001 * support::errorOfDivisions());
}

TEST_P(SoftContacts, AreTheSameForAnyOrderOfSpheres) {
    const scene::Scene scene = meetings(4, setting(), 0.7);
    scene::Scene other = scene;
    std::ranges::reverse(other.spheres);
    std::vector<double> energies = rotationsAfter(other);
    std::ranges::reverse(energies);
    expectTheSame(energies, rotationsAfter(scene), 0.001);
}

// With lengths and speeds 1,000 times as large, masses are 10^9 and energies 10^15 times as large. Moduli are
// proportional to the square of speeds.
TEST_P(SoftContacts, ScaleWithTheScene) {
    const scene::Scene scene = meetings(5, setting(), 0.7);
    scene::Scene large = scene;
    large.bounds.min *= 1000;
    large.bounds.max *= 1000;
    for (scene::Sphere& sphere : large.spheres) {
        sphere.position *= 1000;
        sphere.radius *= 1000;
        sphere.velocity *= 1000;
    }
    for (scene::Material& material : large.materials) material.young *= 1e6;
    expectTheSame(rotationsAfter(large), rotationsAfter(scene), 0.001, 1e15);
}

TEST_P(SoftContacts, ConserveMomentumAndGainNoEnergy) {
    for (const std::uint64_t seed : {6U, 7U}) {
        for (const double e : {0.5, 1.0}) {
            scene::Scene scene = meetings(seed, setting(), e);
            scene.quality.overlap = 0.2;
            ASSERT_TRUE(scene::fitSubsteps(scene));
            const auto simulation = simulate(scene);
            const sim::State start = simulation->snapshot();
            run(*simulation, longEnough);
            const sim::State end = simulation->snapshot();
            for (std::uint32_t id = 0; id < start.count(); id += 2) {
                // About the centre of mass.
                const auto angular = [id](const sim::State& state) {
                    const reference::SoftBody a = bodyOf(state, id);
                    const reference::SoftBody b = bodyOf(state, id + 1);
                    const auto own = [](const reference::SoftBody& body) {
                        return body.spin * (0.4 / body.inverseMass * body.radius * body.radius);
                    };
                    return glm::cross(a.x - b.x, a.v - b.v) / (a.inverseMass + b.inverseMass) + own(a) + own(b);
                };
                const auto linear = [id](const sim::State& state) {
                    return velocityOf(state, id) * massOf(state, id) +
                           velocityOf(state, id + 1) * massOf(state, id + 1);
                };
                const auto energy = [id](const sim::State& state) {
                    double sum = 0;
                    for (std::uint32_t k = id; k < id + 2; ++k) {
                        const reference::SoftBody body = bodyOf(state, k);
                        sum += body.rotationalEnergy() + 0.5 / body.inverseMass * glm::dot(body.v, body.v);
                    }
                    return sum;
                };
                const double scale = massOf(start, id) * glm::length(velocityOf(start, id)) * 0.1;
                EXPECT_LT(glm::length(angular(end) - angular(start)), 2e-5 * scale) << id;
                EXPECT_LT(glm::length(linear(end) - linear(start)),
                          1e-5 * glm::length(velocityOf(start, id)) * massOf(start, id));
                EXPECT_LT(energy(end), energy(start) * 1.001);
            }
        }
    }
}

// In elastic contacts without sliding, only Mindlin's spring loses energy, as its stiffness changes.
TEST_P(SoftContacts, SumOfKineticAndElasticEnergyIsConstant) {
    for (const double friction : {0.0, 0.5}) {
        scene::Scene scene = meetings(8, {.hertz = GetParam(), .walls = false, .friction = friction}, 1, 1);
        scene.step = 1e-4;
        ASSERT_TRUE(scene::fitSubsteps(scene));
        const double h = scene.step / scene.quality.substeps;
        const auto contact = static_cast<int>(2 * scene::contactTimeOf(scene).contact / h / scene.quality.substeps);
        const auto simulation = simulate(scene);
        const auto energyOf = [](const sim::Statistics& s) {
            return s.kineticEnergy + s.rotationalEnergy + s.elasticEnergy;
        };
        const double start = energyOf(simulation->statistics());
        double most = 0;
        for (int k = 0; k < contact + 20; ++k) {
            run(*simulation, scene.step);
            const sim::Statistics now = simulation->statistics();
            most = std::max(most, now.elasticEnergy);
            if (friction == 0) {
                EXPECT_NEAR(energyOf(now), start, 2e-3 * start);
            }
            // With friction, the error of a reading is the work of the tangential force in half a substep.
            EXPECT_LT(energyOf(now), 1.01 * start);
            if (!GetParam()) {
                EXPECT_GT(energyOf(now), 0.99 * start);
            }
        }
        const double end = energyOf(simulation->statistics());
        EXPECT_LT(end, 1.001 * start);
        if (!GetParam()) {
            EXPECT_GT(end, 0.998 * start);
        }
        EXPECT_GT(most, 0.1 * start);
        EXPECT_EQ(simulation->statistics().elasticEnergy, 0) << "they have parted";
    }
}

INSTANTIATE_TEST_SUITE_P(Of, SoftContacts, testing::Bool(),
                         [](const auto& parameter) { return std::string(parameter.param ? "Hertz" : "Linear"); });

// A sphere at rest on the floor stores m g d / 2 in a linear spring, and 2/5 m g d in a Hertz spring.
TEST(SoftFloor, ElasticEnergyMatchesASphereAtRest) {
    for (const bool hertz : {false, true}) {
        scene::Scene scene = soft({.hertz = hertz, .walls = true, .friction = 0.3}, 0.2);
        scene.forces.gravity = {0, 0, -earth};
        scene.step = 1.0 / 60;
        if (hertz)
            for (scene::Material& material : scene.materials) material.young = 1e6;
        scene.spheres = {{.position = {0.3, 0.2, -1 + 0.05}, .radius = 0.05F}};
        ASSERT_TRUE(scene::fitSubsteps(scene));
        const auto simulation = simulate(scene);
        run(*simulation, 1);
        const sim::State state = simulation->snapshot();
        const double depth = static_cast<double>(state.position[0].w) - (positionOf(state, 0).z + 1);
        const double expected = massOf(state, 0) * earth * depth * (hertz ? 0.4 : 0.5);
        EXPECT_NEAR(simulation->statistics().elasticEnergy, expected, 0.02 * expected) << hertz;
    }
}

TEST(SoftFloor, HardSpheresHaveNoElasticEnergy) {
    scene::Scene scene = fineStepBox(1);
    scene.spheres = {{.position = {0, 0, -0.46}, .radius = 0.05F}};
    const auto simulation = simulate(scene);
    EXPECT_EQ(simulation->statistics().elasticEnergy, 0);
    EXPECT_EQ(simulation->plan().statistics.size(), 2U);
}

TEST(SoftFloor, CommandsThatMakeItTooSoftAreRefused) {
    scene::Scene scene = soft({.hertz = true, .walls = true, .friction = 0}, 0.5);
    scene.forces.gravity = {0, 0, -earth};
    scene.spheres = {{.position = {0, 0, 0}, .radius = 0.05F}};
    scene.materials[0].young = 1e6;
    ASSERT_TRUE(scene::fitSubsteps(scene));
    const auto simulation = simulate(scene);
    sim::Set command{.gravity = glm::dvec3(0, 0, -100 * earth)};
    const auto heavier = simulation->apply(command);
    ASSERT_FALSE(heavier);
    EXPECT_EQ(heavier.error().where, "materials[0].young");
    command.model = scene::Model::Balanced;
    ASSERT_TRUE(simulation->apply(command)) << "hard spheres bear it";
    const auto softer = simulation->apply(sim::Set{.model = scene::Model::Accurate});
    ASSERT_FALSE(softer);
    EXPECT_EQ(softer.error().where, "materials[0].young");
    EXPECT_EQ(simulation->scene().quality.model, scene::Model::Balanced);
}

}  // namespace
}  // namespace spherule::physics
