// Obstacles of all shapes but planes, solid, hollow and open, in each model, against exact paths in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <spdlog/fmt/fmt.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr double radius = 0.05;  // m
constexpr scene::Model models[] = {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate};

glm::dvec3 randomDirection(scene::Random& random) {
    return glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
}

std::string text(const glm::dvec3& v) {
    return fmt::format("[{:.17g},{:.17g},{:.17g}]", v.x, v.y, v.z);
}

scene::Obstacle ball(const glm::dvec3& centre, double size, bool hollow) {
    return obstacleFrom(
        fmt::format(R"({{"sphere":{{"centre":{},"radius":{:.17g},"hollow":{}}}}})", text(centre), size, hollow));
}

scene::Obstacle cylinder(const glm::dvec3& from, const glm::dvec3& to, double size, bool hollow) {
    return obstacleFrom(fmt::format(R"({{"cylinder":{{"from":{},"to":{},"radius":{:.17g},"hollow":{}}}}})", text(from),
                                    text(to), size, hollow));
}

// An obstacle around the z axis of its coordinates, in these coordinates turned and moved at random.
struct Turned {
    glm::dvec3 axis;
    double degrees;
    glm::dvec3 to;

    explicit Turned(scene::Random& random)
        : axis(randomDirection(random)),
          degrees(random.uniform(-360, 360)),
          to(random.uniform(0, 2) * randomDirection(random)) {}

    [[nodiscard]] scene::Obstacle obstacle(const std::string& shape) const {
        return obstacleFrom(fmt::format(R"({{{},"rotation":{{"axis":{},"degrees":{:.17g}}},"translation":{}}})", shape,
                                        text(axis), degrees, text(to)));
    }
    // Returns the vector that the turn makes of v, by the formula of Rodrigues.
    [[nodiscard]] glm::dvec3 turn(const glm::dvec3& v) const {
        const double angle = degrees * std::numbers::pi / 180;
        return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
               axis * glm::dot(axis, v) * (1 - std::cos(angle));
    }
    [[nodiscard]] glm::dvec3 place(const glm::dvec3& point) const { return turn(point) + to; }
};

// A shape of about 1 m around the z axis.
std::string randomShape(unsigned kind, scene::Random& random) {
    const double h = random.uniform(0.2, 0.8);
    const double a = random.uniform(0.2, 0.8);
    const double b = random.uniform(0.2, 0.8);
    const std::string ends = fmt::format(R"("from":[0,0,{}],"to":[0,0,{}])", -h, h);
    const std::string box = fmt::format(R"("box":{{"min":[{},{},{}],"max":[{},{},{}])", -a, -b, -h, a, b, h);
    const std::string cone = fmt::format(R"("cone":{{{},"fromRadius":{},"toRadius":{})", ends, a, b);
    const std::string capsule = fmt::format(R"("capsule":{{{},"radius":{})", ends, a);
    const std::string disc = fmt::format(R"("disc":{{"centre":[0,0,0],"normal":[0,0,2],"radius":{})", 0.5 + a);
    const std::string shapes[] = {box,
                                  box + R"(,"hollow":true)",
                                  cone,
                                  cone + R"(,"hollow":true)",
                                  cone + R"(,"open":true)",
                                  disc,
                                  disc + fmt::format(R"(,"hole":{})", a - 0.1),
                                  fmt::format(R"("cylinder":{{{},"radius":{},"open":true)", ends, a),
                                  capsule,
                                  capsule + R"(,"hollow":true)"};
    return shapes[kind] + "}";
}
constexpr unsigned shapeKinds = 10;

// One sphere in open space, with steps of one substep of 1/480 s; `accurate` with substeps of 1/14,400 s.
scene::Scene oneSphere(scene::Model model, const glm::dvec3& place, const glm::dvec3& velocity) {
    scene::Scene scene = fineStepSpace(20);
    scene.quality = {.model = model, .substeps = model == scene::Model::Accurate ? 30U : 1U};
    measure::addSphere(scene, place, radius, velocity);
    return scene;
}

struct Motion {
    glm::dvec3 x;
    glm::dvec3 v;
};

Motion stateOf(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    return {glm::dvec3(glm::vec3(state.position[0])) + simulation.scene().bounds.centre(),
            glm::dvec3(glm::vec3(state.velocity[0]))};
}

class Obstacles : public testing::TestWithParam<scene::Model> {};

// The normal of the surface at a point, by differences of the distance.
glm::dvec3 normalAt(const scene::Shape& shape, const glm::dvec3& point) {
    constexpr double step = 1e-6;
    glm::dvec3 slope(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 by(0);
        by[axis] = step;
        slope[axis] = shape.distance(point + by) - shape.distance(point - by);
    }
    return glm::normalize(slope);
}

// The time at which a sphere on a straight path first touches the obstacle (s); 10 if it is not within two seconds.
double meetingTime(const scene::Shape& shape, const Motion& start) {
    constexpr double step = 1e-3;
    const auto gap = [&](double t) { return shape.distance(start.x + start.v * t) - radius; };
    for (double t = 0; t < 2; t += step) {
        if (gap(t + step) > 0) continue;
        double low = t;
        double high = t + step;
        for (int k = 0; k < 60; ++k) (gap(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
        return low;
    }
    return 10;
}

struct Target {
    scene::Obstacle obstacle;
    glm::dvec3 centre;
    double size;  // m
};

// Spheres that come from random places, within the target or around it, at random times. `softSubsteps`: of `accurate`.
// `targetOf`: the target of a case.
void expectReboundsOfTheNormal(scene::Model model, scene::Random& random, unsigned cases, unsigned softSubsteps,
                               const std::function<Target(unsigned)>& targetOf) {
    constexpr double seconds = 0.02;  // after the rebound
    unsigned met = 0;
    double worst = 0;  // error of the speed after the rebound, over the speed before
    while (met < cases) {
        const Target target = targetOf(met);
        const scene::Shape& shape = *target.obstacle.shape;
        const bool inside = random.uniform() < 0.5;
        const glm::dvec3 from = target.centre + randomDirection(random) * (inside ? random.uniform(0, 0.1) : 3.0);
        const glm::dvec3 aim = target.centre + randomDirection(random) * random.uniform(0, 0.9) * target.size;
        const glm::dvec3 v = glm::normalize(aim - from) * random.uniform(0.5, 4);
        if (shape.distance(from) < 1.5 * radius) continue;
        const double meeting = meetingTime(shape, {from, v});
        if (meeting > 2) continue;
        const double time = std::min(meeting, random.uniform(0.005, 0.03));
        const Motion start{from + v * (meeting - time), v};
        const double e = random.uniform(0, 1);
        const glm::dvec3 place = start.x + start.v * time;
        const glm::dvec3 n = normalAt(shape, place);
        const glm::dvec3 after = start.v - (1 + e) * glm::dot(start.v, n) * n;
        if (meetingTime(shape, {place + after * 1e-3, after}) < 2 * seconds) continue;  // in a corner
        ++met;
        scene::Scene scene = oneSphere(model, start.x, start.v);
        // While a soft contact at an edge lasts, its normal turns: here contacts are short.
        if (model == scene::Model::Accurate) scene.quality.substeps = softSubsteps;
        scene.obstacles.push_back(target.obstacle);
        setRestitution(scene, e);
        const auto simulation = simulate(scene);
        run(*simulation, time + seconds);
        const Motion end = stateOf(*simulation);
        const double speed = glm::length(start.v);
        EXPECT_NEAR(glm::length(end.v), glm::length(after), 0.01 * speed) << met;
        worst = std::max(worst, std::abs(glm::length(end.v) - glm::length(after)) / speed);
        // During a soft contact the sphere moves along the surface, and the normal turns.
        const bool soft = model == scene::Model::Accurate;
        EXPECT_LT(glm::distance(end.v, after), (soft ? 0.03 : 0.01) * speed) << met;
        const glm::dvec3 there = place + after * (simulation->time() - time);
        EXPECT_LT(glm::distance(end.x, there), soft ? radius : 4e-5 * speed + 2e-5) << met;
    }
    testing::Test::RecordProperty("worst", std::to_string(worst * 1e6) + "e-6");
}

TEST_P(Obstacles, ReboundsAreThoseOfTheNormal) {
    scene::Random random(21);
    const unsigned cases = GetParam() == scene::Model::Accurate ? 16 : 60;
    expectReboundsOfTheNormal(GetParam(), random, cases, 30, [&](unsigned k) -> Target {
        const glm::dvec3 centre = randomDirection(random) * random.uniform(0, 2);
        const glm::dvec3 half = randomDirection(random) * random.uniform(0.2, 1);
        const double size = random.uniform(0.2, 1);
        const bool hollow = k % 2 == 1;
        return {k % 4 < 2 ? ball(centre, size, hollow) : cylinder(centre - half, centre + half, size, hollow), centre,
                size};
    });
}

TEST_P(Obstacles, ReboundsFromTurnedShapesAreThoseOfTheNormal) {
    scene::Random random(22);
    const unsigned cases = (GetParam() == scene::Model::Accurate ? 2 : 8) * shapeKinds;
    expectReboundsOfTheNormal(GetParam(), random, cases, 300, [&](unsigned k) -> Target {
        const Turned turned(random);
        return {turned.obstacle(randomShape(k % shapeKinds, random)), turned.to, 0.5};
    });
}

// A sphere slides or rolls down the face of a turned box as down a plane.
TEST_P(Obstacles, TheFaceOfATurnedBoxIsAPlane) {
    scene::Random random(26);
    double worst = 0;  // distance between the spheres, m
    for (int k = 0; k < (GetParam() == scene::Model::Accurate ? 2 : 8); ++k) {
        const Turned turned(random);
        const glm::dvec3 up = turned.turn({0, 0, 1});
        const glm::dvec3 start = turned.place({random.uniform(-1, 1), random.uniform(-1, 1), 3 + radius});
        glm::dvec3 ends[2];
        for (const bool box : {false, true}) {
            scene::Scene scene = oneSphere(GetParam(), start, 0.5 * turned.turn({1, 0.3, 0}));
            scene.forces.gravity = -earth * up + 2.0 * turned.turn({0.3, -1, 0});
            scene.materials[0].friction = 0.3;
            scene.obstacles.push_back(box ? turned.obstacle(R"("box":{"min":[-4,-4,2],"max":[4,4,3]})")
                                          : turned.obstacle(R"("plane":{"point":[0,0,3],"normal":[0,0,1]})"));
            const auto simulation = simulate(scene);
            run(*simulation, GetParam() == scene::Model::Accurate ? 0.3 : 1);
            ends[box ? 1 : 0] = stateOf(*simulation).x;
        }
        worst = std::max(worst, glm::distance(ends[0], ends[1]));
    }
    EXPECT_LT(worst, 1e-3 * radius);
    RecordProperty("worst", std::to_string(worst * 1e9) + "e-9 m");
}

// A sphere lies on the edge of a hole, in the tip of an open cone, or in the tip of a hollow one, and stays there. Its
// centre is sqrt(r^2 - q^2) above a hole of radius q. Its distance from a tip is r / sin of half the angle.
TEST_P(Obstacles, SphereStaysInAHoleAndInATip) {
    const bool soft = GetParam() == scene::Model::Accurate;
    scene::Random random(27);
    double farthest = 0;  // from the start, m
    double drift = 0;     // after a tenth of the time, m
    for (int k = 0; k < (soft ? 3 : 9); ++k) {
        const Turned turned(random);
        const double hole = random.uniform(0.3, 0.8) * radius;
        const double slope = random.uniform(0.5, 2);  // height of the cone over its radius
        const double tip = radius * std::sqrt(1 + slope * slope);
        const char* const open = k % 3 == 1 ? "\"open\":true" : "\"hollow\":true";
        const double height = k % 3 == 0 ? std::sqrt(radius * radius - hole * hole) : tip;
        scene::Scene scene = oneSphere(GetParam(), turned.place({0, 0, height}), {});
        scene.obstacles.push_back(turned.obstacle(
            k % 3 == 0
                ? fmt::format(R"("disc":{{"centre":[0,0,0],"normal":[0,0,1],"radius":1,"hole":{:.17g}}})", hole)
                : fmt::format(R"("cone":{{"from":[0,0,0],"to":[0,0,{:.17g}],"toRadius":0.5,{}}})", 0.5 * slope, open)));
        scene.forces.gravity = -earth * turned.turn({0, 0, 1});
        scene.materials[0].friction = 0.5;
        setRestitution(scene, 0);
        scene.sleep.enabled = false;
        if (soft) scene.quality.substeps = 100;
        const auto simulation = simulate(scene);
        const glm::dvec3 start = stateOf(*simulation).x;
        const int tenths = soft ? 20 : 600;
        glm::dvec3 settled{};
        for (int tenth = 0; tenth < tenths; ++tenth) {
            run(*simulation, 0.1);
            const glm::dvec3 now = stateOf(*simulation).x;
            farthest = std::max(farthest, glm::distance(now, start));
            if (tenth == tenths / 10) settled = now;
            if (tenth > tenths / 10) drift = std::max(drift, glm::distance(now, settled));
        }
    }
    EXPECT_LT(farthest, (soft ? 0.05 : 5e-3) * radius);
    // By larger errors of rounding, a sphere in a round hole slips now and then by a few times the overlap that
    // contacts keep (0.001 radii).
    EXPECT_LT(drift, (soft || support::errorOfDivisions() == 1 ? 1e-4 : 5e-3) * radius);
    RecordProperty("farthest", std::to_string(farthest * 1e9) + "e-9 m");
    RecordProperty("drift", std::to_string(drift * 1e9) + "e-9 m");
}

// A sphere without bounce in a hollow of radius `size`, in contact, where gravity pulls along `down`.
scene::Scene oneRolling(scene::Model model, const scene::Obstacle& hollow, const glm::dvec3& place,
                        const glm::dvec3& down) {
    scene::Scene scene = oneSphere(model, place, {});
    scene.obstacles.push_back(hollow);
    scene.forces.gravity = earth * down;
    scene.materials[0].friction = 1;
    setRestitution(scene, 0);
    if (model == scene::Model::Accurate) {
        scene.quality.substeps = 100;
        scene.quality.overlap = 0.01;
        scene.sphereContacts = false;  // its substeps are many
    }
    return scene;
}

// A sphere that rolls without slip in a hollow cylinder, across the axis, or in a hollow sphere is a pendulum:
// a'' = -5/7 g / (R - r) sin a.
TEST_P(Obstacles, SphereRollsInAHollowAsAPendulum) {
    const bool soft = GetParam() == scene::Model::Accurate;
    scene::Random random(23);
    double worstOfAll = 0;
    for (int k = 0; k < (soft ? 2 : 4); ++k) {
        const double size = random.uniform(0.3, 1.2);
        const glm::dvec3 axis = randomDirection(random);
        const glm::dvec3 down = glm::normalize(glm::cross(axis, randomDirection(random)));
        const glm::dvec3 side = glm::cross(axis, down);
        const double path = size - radius;
        double angle = random.uniform(0.3, 1);
        double turning = 0;
        const scene::Obstacle hollow = k % 2 == 0 ? cylinder(-axis, axis, size, true) : ball({}, size, true);
        const glm::dvec3 start = path * (std::cos(angle) * down + std::sin(angle) * side);
        const auto simulation = simulate(oneRolling(GetParam(), hollow, start, down));
        const double fastest = std::sqrt(10.0 / 7 * earth * path * (1 - std::cos(angle)));
        const auto pull = [&](double a) { return -5.0 / 7 * earth / path * std::sin(a); };
        double worst = 0;
        for (int tenth = 0; tenth < (soft ? 5 : 25); ++tenth) {
            run(*simulation, 0.1);
            constexpr int steps = 2000;
            const double h = 0.1 / steps;
            for (int step = 0; step < steps; ++step) {  // leapfrog
                turning += 0.5 * h * pull(angle);
                angle += h * turning;
                turning += 0.5 * h * pull(angle);
            }
            const glm::dvec3 along = std::cos(angle) * side - std::sin(angle) * down;
            worst = std::max(worst, std::abs(glm::dot(stateOf(*simulation).v, along) - path * turning) / fastest);
        }
        EXPECT_LT(worst, GetParam() == scene::Model::Fast ? 0.02 : (soft ? 2e-3 : 1e-3)) << size;
        worstOfAll = std::max(worstOfAll, worst);
    }
    RecordProperty("worst", std::to_string(worstOfAll * 1e6) + "e-6");
}

// Returns the speed at which a sphere rolls whose contact is at `lever` radii from its centre, after it has rolled at
// `speed` with a lever of 1. Friction F changes the speed by F / m and the spin by F lever / (2/5 m r), until the speed
// is the spin times the lever.
double rollingSpeed(double speed, double lever) {
    return speed * (1 + 0.4 / lever) / (1 + 0.4 / (lever * lever));
}

// Along the axis of a hollow cylinder a sphere keeps its speed. An overlap makes the lever shorter, and the sphere
// slower.
TEST_P(Obstacles, SphereRollsAlongAHollowCylinder) {
    const bool soft = GetParam() == scene::Model::Accurate;
    scene::Random random(24);
    double worst = 0;
    for (int k = 0; k < 12; ++k) {
        const double size = random.uniform(0.2, 1);
        const glm::dvec3 axis = randomDirection(random);
        const glm::dvec3 down = glm::normalize(glm::cross(axis, randomDirection(random)));
        scene::Scene scene = oneRolling(GetParam(), cylinder(-3.0 * axis, 3.0 * axis, size, true),
                                        (size - radius) * down - 2.0 * axis, down);
        if (soft) scene.quality.substeps = 60;  // more substeps round the velocity more often
        const double speed = random.uniform(1, 5);
        scene.spheres[0].velocity = glm::vec3(speed * axis);
        scene.spheres[0].spin = glm::vec3(glm::cross(-down, speed * axis) / radius);
        const auto simulation = simulate(scene);
        run(*simulation, soft ? 0.1 : 0.8);
        const Motion end = stateOf(*simulation);
        const double depth = glm::length(end.x - axis * glm::dot(end.x, axis)) - (size - radius);
        const double expected = rollingSpeed(speed, 1 - std::max(depth, 0.0) / radius);
        worst = std::max(worst, std::abs(glm::dot(end.v, axis) / expected - 1));
    }
    EXPECT_LT(worst, 1e-4);
    RecordProperty("worst", std::to_string(worst * 1e6) + "e-6");
}

// A sphere that falls through pegs, with the lists of near obstacles and without, where it visits all of them.
TEST_P(Obstacles, ListsLeaveOutNoObstacleThatASphereMeets) {
    scene::Random random(25);
    for (int k = 0; k < (GetParam() == scene::Model::Accurate ? 2 : 8); ++k) {
        const glm::dvec3 start(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 2.4);
        scene::Scene scene = oneSphere(GetParam(), start, {});
        scene.forces.gravity = {0, 0, -earth};
        setRestitution(scene, 0.6);
        for (int peg = 0; peg < 60; ++peg) {
            const glm::dvec3 place(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-2, 2));
            const glm::dvec3 half = 0.3 * randomDirection(random);
            scene.obstacles.push_back(peg % 2 == 0 ? ball(place, random.uniform(0.05, 0.15), false)
                                                   : cylinder(place - half, place + half, 0.06, false));
        }
        std::uint64_t hashes[2];
        for (const bool contacts : {false, true}) {
            scene.sphereContacts = contacts;
            const auto simulation = simulate(scene);
            run(*simulation, GetParam() == scene::Model::Accurate ? 0.7 : 1.2);
            hashes[contacts ? 1 : 0] = sim::hashOf(simulation->snapshot());
        }
        EXPECT_EQ(hashes[0], hashes[1]) << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Obstacles, testing::ValuesIn(models),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

}  // namespace
}  // namespace spherule::physics
