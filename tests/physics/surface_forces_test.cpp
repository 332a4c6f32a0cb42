// The forces and torques of spheres on walls and obstacles, in scenes with contact sums.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "beds.h"
#include "figures.h"
#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {
namespace {

using measure::addSphere;
using measure::setFriction;
using scene::Model;

double weightOf(const sim::State& state) {
    double weight = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) weight += massOf(state, id) * earth;
    return weight;
}

// All loads of surfaces together.
sim::SurfaceLoad sumOf(const sim::ContactSums& sums) {
    sim::SurfaceLoad sum;
    for (const sim::SurfaceLoad& load : sums.loads) {
        sum.impulse += load.impulse;
        sum.moment += load.moment;
    }
    return sum;
}

const sim::SurfaceForce& forceOn(const sim::Statistics& statistics, const std::string& surface) {
    for (const sim::SurfaceForce& on : statistics.surfaceForces)
        if (on.surface == surface) return on;
    throw std::logic_error("no force on " + surface);
}

// The means over the next seconds.
sim::Statistics meansOver(sim::Simulation& simulation, double seconds) {
    const sim::ContactSums before = *simulation.statistics().contactSums;
    run(simulation, seconds);
    sim::Statistics now = simulation.statistics();
    sim::setMeans(now, now.contactSums->since(before), simulation.scene());
    return now;
}

class SurfaceForces : public testing::TestWithParam<Model> {};

// A sphere at rest on a plane of any orientation loads it with its weight, below its centre.
TEST_P(SurfaceForces, OfARestingSphereAreItsWeight) {
    scene::Random random(31);
    double worst = 0;
    for (int k = 0; k < (GetParam() == Model::Accurate ? 2 : 6); ++k) {
        const glm::dvec3 up = glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
        const glm::dvec3 foot(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
        scene::Scene scene = fineStepSpace(1.2);
        scene.forces.gravity = -earth * up;
        scene.quality.overlap = 0.01;
        setRestitution(scene, 0);
        setFriction(scene, k % 2 == 0 ? 0.5 : 0);
        scene.materials[0].rollingResistance = k % 2 == 0 ? 0.1 : 0;
        scene.obstacles.push_back({.shape = scene::planeShape(foot, up), .colour = ""});
        const double radius = random.uniform(0.1, 0.2);
        addSphere(scene, foot + radius * up, radius);
        measureContacts(scene, GetParam());
        auto simulation = simulate(scene);
        run(*simulation, 0.3);
        const sim::Statistics now = meansOver(*simulation, 0.2);
        const double weight = weightOf(simulation->snapshot());
        const sim::SurfaceForce& on = forceOn(now, "obstacles[0]");
        worst = std::max({worst, glm::length(on.force + weight * up) / weight,
                          glm::length(on.torque - glm::cross(foot, -weight * up)) / weight});
        EXPECT_EQ(now.surfaceForces.size(), 1U) << "open faces bear nothing";
    }
    EXPECT_LT(worst, 1e-5);
    RecordProperty("restingSphere", figure(worst));
}

// Mixed spheres in a closed box with obstacles of each shape, without gravity.
scene::Scene rattle(Model model, std::uint64_t seed) {
    scene::Scene scene = fineStepSpace(1.2);
    scene.bounds.open.fill(false);
    scene.bounds.min += glm::dvec3(3, -2, 1);  // forces act about the centre
    scene.bounds.max += glm::dvec3(3, -2, 1);
    setRestitution(scene, 0.8);
    setFriction(scene, 0.4);
    scene.materials[0].rollingResistance = 0.05;
    scene.obstacles = {
        obstacleFrom(R"({"sphere": {"centre": [3, -2, 1], "radius": 0.1}})"),
        obstacleFrom(R"({"box": {"min": [3.25, -2.6, 0.4], "max": [3.35, -1.4, 1]}})"),
        obstacleFrom(R"({"cylinder": {"from": [2.6, -2.3, 0.8], "to": [2.9, -1.8, 1.2], "radius": 0.05}})"),
        obstacleFrom(R"({"plane": {"point": [3, -2.5, 0.5], "normal": [0.1, 1, 0.8]}})"),
        obstacleFrom(R"({"cylinder": {"from": [3, -2, 0.3], "to": [3, -2, 1.55], "radius": 0.75,
                                                     "hollow": true}})")};
    // These touch a face and an obstacle from the beginning.
    addSphere(scene, {2.4 + 0.0298, -2, 1.2}, 0.03, {-1, 0.3, 0.2});
    addSphere(scene, {3, -2, 1.1 + 0.0298}, 0.03, {0.2, 0.5, -1});
    scene::Random random(seed);
    while (scene.spheres.size() < 60) {
        const glm::dvec3 place =
            scene.bounds.centre() +
            glm::dvec3(random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.5), random.uniform(-0.3, 0.5));
        const double radius = random.uniform(0.02, 0.05);
        bool free = true;
        for (const scene::Obstacle& obstacle : scene.obstacles) free = free && obstacle.shape->distance(place) > radius;
        for (const scene::Sphere& other : scene.spheres)
            free = free && glm::distance(other.position, place) > radius + static_cast<double>(other.radius);
        if (!free) continue;
        addSphere(scene, place, radius, {random.normal(), random.normal(), random.normal()});
        scene.spheres.back().spin = glm::vec3(random.normal(), random.normal(), random.normal()) * 10.0F;
    }
    measureContacts(scene, model);
    return scene;
}

// Walls and obstacles get the momentum and the angular momentum that the spheres lose. `fast` and `balanced` also move
// spheres out of walls and to the place of an impact, which turns their angular momentum a little.
TEST_P(SurfaceForces, TakeTheMomentumThatTheSpheresLose) {
    double linear = 0;
    double angular = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        auto simulation = simulate(rattle(GetParam(), seed));
        const sim::Statistics before = simulation->statistics();
        run(*simulation, GetParam() == Model::Accurate ? 0.2 : 1);
        const sim::Statistics after = simulation->statistics();
        const sim::SurfaceLoad taken = sumOf(*after.contactSums);
        double passed = 0;  // N s: between spheres and surfaces, whatever its direction
        for (const sim::SurfaceLoad& load : after.contactSums->loads) passed += glm::length(load.impulse);
        EXPECT_GT(passed, 1);
        linear = std::max(linear, glm::length(before.momentum - after.momentum - taken.impulse) / passed);
        angular =
            std::max(angular, glm::length(before.angularMomentum - after.angularMomentum - taken.moment) / passed);
    }
    EXPECT_LT(linear, 1e-6);
    EXPECT_LT(angular, GetParam() == Model::Accurate ? 1e-6 : 1e-3);
    RecordProperty("momentum", figure(linear));
    RecordProperty("angularMomentum", figure(angular));
}

// The same with gravity, while spheres settle in heaps.
TEST_P(SurfaceForces, BearTheWeightOfAHeap) {
    double worst = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        scene::Scene scene = rattle(GetParam(), seed);
        scene.forces.gravity = {1, -2, -9};
        setRestitution(scene, 0.3);
        measureContacts(scene, GetParam());
        auto simulation = simulate(scene);
        const sim::Statistics before = simulation->statistics();
        run(*simulation, GetParam() == Model::Accurate ? 0.3 : 2);
        const sim::Statistics after = simulation->statistics();
        const sim::ContactSums sums = after.contactSums->since(*before.contactSums);
        const glm::dvec3 pull = weightOf(simulation->snapshot()) / earth * scene.forces.gravity * sums.seconds;
        const glm::dvec3 taken = sumOf(sums).impulse;
        worst = std::max(worst, glm::length(before.momentum + pull - after.momentum - taken) / glm::length(pull));
    }
    // In free flight, `accurate` rounds the velocity in each of its many substeps.
    EXPECT_LT(worst, GetParam() == Model::Accurate ? 6e-4 : 1e-5);
    RecordProperty("heap", figure(worst));
}

// The sums are whole numbers, so they do not depend on devices, threads and lanes.
TEST_P(SurfaceForces, HaveTheSameBitsOnAllDevices) {
    scene::Scene scene = rattle(GetParam(), 7);
    scene.forces.gravity = {0, 0, -earth};
    std::vector<sim::SurfaceLoad> expected;
    for (const char* kind : {"cpu:1x1", "cpu:2x4", "cpu:3x8", "software"}) {
        const auto on = compute::openDevice(kind).value();
        auto simulation = simulate(scene, *on);
        run(*simulation, GetParam() == Model::Accurate ? scene.step : 0.1);
        const std::vector<sim::SurfaceLoad> loads = simulation->statistics().contactSums->loads;
        if (expected.empty()) expected = loads;
        ASSERT_EQ(loads.size(), expected.size());
        EXPECT_GT(glm::length(sumOf(*simulation->statistics().contactSums).impulse), 0);
        for (std::size_t k = 0; k < loads.size(); ++k) {
            EXPECT_EQ(loads[k].impulse, expected[k].impulse) << kind << ", surface " << k;
            EXPECT_EQ(loads[k].moment, expected[k].moment) << kind << ", surface " << k;
        }
    }
}

// A small sphere and one of a ton: the units suit the sum of their masses, and both weights are right.
TEST_P(SurfaceForces, HaveRoomForSpheresOfAnySize) {
    scene::Scene scene = fineStepBox(8);
    setRestitution(scene, 0);
    scene.quality.overlap = 0.01;
    scene.sphereContacts = false;
    addSphere(scene, {0, 0, -4 + 0.6}, 0.6);
    const double small = GetParam() == Model::Accurate ? 0.03 : 6e-4;  // `accurate` would need many substeps
    addSphere(scene, {2, 0, -3 + small}, small);
    scene.obstacles.push_back({.shape = scene::boxShape({{1, -1, -4}, {3, 1, -3}}), .colour = ""});
    measureContacts(scene, GetParam());
    auto simulation = simulate(scene);
    run(*simulation, 0.1);
    const sim::Statistics now = meansOver(*simulation, 0.1);
    const sim::State state = simulation->snapshot();
    EXPECT_NEAR(forceOn(now, "Z_MIN").force.z / (massOf(state, 0) * earth), -1, 1e-4);
    EXPECT_NEAR(forceOn(now, "obstacles[0]").force.z / (massOf(state, 1) * earth), -1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Of, SurfaceForces, testing::Values(Model::Fast, Model::Balanced, Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

// The walls bear no weight without friction: the floor bears all.
class FloorForce : public testing::TestWithParam<Model> {};

TEST_P(FloorForce, IsTheWeightOfABedAtRest) {
    const bool soft = GetParam() == Model::Accurate;
    std::string found;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        scene::Scene scene = bed({.count = soft ? 100U : 400U, .depth = soft ? 4.0 : 8.0, .friction = 0, .seed = seed});
        if (soft) scene = asAccurate(std::move(scene), 0.05);
        scene.contactSums = true;
        auto simulation = simulate(scene);
        run(*simulation, soft ? 2 : 4);
        const sim::Statistics now = meansOver(*simulation, 0.5);
        const double weight = weightOf(simulation->snapshot());
        const double share = -forceOn(now, "Z_MIN").force.z / weight;
        EXPECT_NEAR(share, 1, 0.01) << seed;
        found += figure(share) + " ";
    }
    RecordProperty("floor", found);
}

INSTANTIATE_TEST_SUITE_P(Of, FloorForce, testing::Values(Model::Balanced, Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

// Sleepers keep the forces with which they fell asleep. With friction, the walls bear a part of the weight.
TEST(SleeperForces, AreTheWeightOfTheBed) {
    std::string found;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        scene::Scene scene = bed({.count = 400, .depth = 8, .friction = 0.4, .seed = seed});
        scene.sleep = {.enabled = true, .speed = 0.02, .time = 0.5};
        scene.contactSums = true;
        auto simulation = simulate(scene);
        run(*simulation, 6);
        const sim::Statistics now = meansOver(*simulation, 0.5);
        ASSERT_GT(now.sleeping, 360U) << seed;
        double sum = 0;
        for (const sim::SurfaceForce& on : now.surfaceForces) sum += on.force.z;
        const double weight = weightOf(simulation->snapshot());
        EXPECT_NEAR(sum, -weight, 0.01 * weight) << seed;
        found += figure(-sum / weight) + " ";
    }
    RecordProperty("asleep", found);
}

// Ten spheres are added high above a bed at rest: what it exerts stays the same, because its contacts keep their
// memory.
TEST(FloorForceOfAccurate, OutlastsASpawn) {
    double worst = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        scene::Scene scene = bed({.count = 100, .depth = 4, .friction = 0.3, .seed = seed});
        scene.materials[0].young = 1e6;  // else the height from which the new ones fall changes the stiffness
        scene = asAccurate(std::move(scene), 0.05);
        scene.contactSums = true;
        auto simulation = simulate(scene);
        run(*simulation, 2);
        const double before = forceOn(meansOver(*simulation, 0.05), "Z_MIN").force.z;
        const double top = scene.bounds.max.z - 2 * bedRadius;
        const sim::Spawn ten{.name = "ten", .look = {}, .place = [top](const scene::Scene&, Progress&) {
                                 std::vector<scene::Sphere> spheres;
                                 for (int k = 0; k < 10; ++k)
                                     spheres.push_back({.position = {0.11 * (k % 3 - 1), 0.11 * (k / 3 - 1.5), top},
                                                        .radius = static_cast<float>(bedRadius)});
                                 return Result<std::vector<scene::Sphere>>(std::move(spheres));
                             }};
        const std::uint32_t generation = simulation->generation();
        ASSERT_TRUE(simulation->apply(ten));
        EXPECT_EQ(simulation->generation(), generation);
        const double after = forceOn(meansOver(*simulation, 0.05), "Z_MIN").force.z;
        worst = std::max(worst, std::abs(after / before - 1));
    }
    EXPECT_LT(worst, 1e-3);
    RecordProperty("afterSpawn", figure(worst));
}

}  // namespace
}  // namespace spherule::physics
