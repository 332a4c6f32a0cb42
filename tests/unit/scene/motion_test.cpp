// Motions of obstacles: as scenes give them, and as functions of the time.
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "scene/describe.h"
#include "scene/motion.h"
#include "scene/obstacle_changes.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "scene/surroundings.h"
#include "scene_support.h"
#include "spherule/v1/control.pb.h"

namespace spherule::scene::testing {
namespace {

constexpr double pi = std::numbers::pi;

std::string withMotion(const std::string& motion,
                       const std::string& shape = R"("sphere": {"centre": [5, 5, 5], "radius": 1})") {
    return R"({"bounds": {"min": [0,0,0], "max": [10,10,10]},
               "groups": [{"list": {"spheres": [{"position": [1, 1, 1], "radius": 0.1}]}}],
               "obstacles": [{)" +
           shape + R"(, "motion": {)" + motion + "}}]}";
}

Motion motionFrom(const std::string& motion,
                  const std::string& shape = R"("sphere": {"centre": [5, 5, 5], "radius": 1})") {
    const auto scene = build(parsed(withMotion(motion, shape)));
    EXPECT_TRUE(scene) << scene.error().text();
    return scene->obstacles.at(0).motion.value();
}

std::string refusalOfMotion(const std::string& motion) {
    const auto scene = build(parsed(withMotion(motion)));
    return scene ? "accepted" : scene.error().text();
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    EXPECT_LT(glm::distance(a, b), tolerance)
        << a.x << " " << a.y << " " << a.z << ", not " << b.x << " " << b.y << " " << b.z;
}

TEST(SceneMotion, IsAbsentOrMovesSomething) {
    EXPECT_EQ(refusalOfMotion(""),
              "obstacles[0].motion: moves nothing; give one of velocity, acceleration, spin, oscillations, keyframes, "
              "belt and drive");
    EXPECT_FALSE(build(parsed(R"({"bounds": {"min": [0,0,0], "max": [9,9,9]},
                                  "obstacles": [{"sphere": {"centre": [5,5,5], "radius": 1}}]})"))
                     ->obstacles[0]
                     .motion);
}

TEST(SceneMotion, TurnsAboutItsPivot) {
    const Motion motion = motionFrom(R"("spin": [0, 0, 2], "pivot": [4, 5, 5], "velocity": [0, 0, 0.5])");
    const double quarter = pi / 4;  // s
    expectNear(motion.poseAt(quarter).frame().outside({5, 5, 5}), {4, 6, 5 + 0.5 * quarter});
}

// The default pivot is the origin of the shape's coordinates, about which the scene turns the shape too.
TEST(SceneMotion, HasThePivotOfTheShapesCoordinates) {
    const Motion motion =
        motionFrom(R"("spin": [0, 0, 2])", R"("box": {"min": [-1,-1,-1], "max": [1,1,1]}, "translation": [5, 4, 5])");
    expectNear(motion.pivot, {5, 4, 5});
}

TEST(SceneMotion, OscillatesFromItsPlace) {
    const Motion motion = motionFrom(
        R"("oscillations": [{"amplitude": [0.1, 0, 0], "frequency": 2, "phase": 90}, {"swing": [0, 0, 0.3], "frequency": 1}], "pivot": [0, 0, 0])");
    expectNear(motion.poseAt(0).frame().outside({1, 2, 3}), {1, 2, 3});
    const Pose pose = motion.poseAt(0.25);
    expectNear(pose.shift, {-0.2, 0, 0});
    expectNear(pose.turn * glm::dvec3(1, 0, 0), {std::cos(0.3), std::sin(0.3), 0});
    // A million periods later it is at the same place.
    expectNear(motion.poseAt(1e6 + 0.25).shift, {-0.2, 0, 0}, 1e-8);
}

TEST(SceneMotion, FollowsKeyframes) {
    const Motion motion = motionFrom(R"("pivot": [0, 0, 0], "keyframes": [
        {"time": 1, "translation": [1, 0, 0]},
        {"time": 2, "translation": [1, 0, 0], "rotation": {"axis": [0, 0, 3], "degrees": 270}},
        {"time": 4}], "repeat": true)");
    expectNear(motion.poseAt(0.5).shift, {0.5, 0, 0});
    // Three quarters of a turn, not one quarter backwards.
    expectNear(motion.poseAt(1 + 1.0 / 3).turn * glm::dvec3(1, 0, 0), {0, 1, 0});
    expectNear(motion.poseAt(3).shift, {0.5, 0, 0});
    expectNear(motion.poseAt(4.5).shift, {0.5, 0, 0});
    EXPECT_NEAR(motion.speeds().pivot, 1, 1e-12);
    EXPECT_NEAR(motion.speeds().turn, 1.5 * pi, 1e-9);
    const Motion once = motionFrom(R"("keyframes": [{"time": 1, "translation": [1, 0, 0]}])");
    expectNear(once.poseAt(9).shift, {1, 0, 0});
}

TEST(SceneMotion, BeginsAndEnds) {
    const Motion motion = motionFrom(R"("velocity": [1, 0, 0], "acceleration": [2, 0, 0], "begin": 1, "duration": 3)");
    expectNear(motion.poseAt(0.9).shift, {0, 0, 0});
    expectNear(motion.poseAt(2).shift, {2, 0, 0});
    expectNear(motion.poseAt(7).shift, {12, 0, 0});
    EXPECT_NEAR(motion.speeds().pivot, 7, 1e-12);
    EXPECT_FALSE(motion.runsBetween(0.8, 0.9));
    EXPECT_TRUE(motion.runsBetween(0.9, 1.1));
    EXPECT_FALSE(motion.runsBetween(4.1, 4.2));
}

// No point of the surface is faster than the bound, for random motions.
TEST(SceneMotion, IsNotFasterThanItsBound) {
    Random random(61);
    const auto vector = [&](double size) {
        return size * glm::dvec3(random.normal(), random.normal(), random.normal());
    };
    for (int k = 0; k < 50; ++k) {
        Obstacle obstacle{.shape = boxShape({{-0.3, -0.2, -0.1}, {0.3, 0.2, 0.1}}), .colour = ""};
        Motion motion{.velocity = vector(1), .spin = vector(1), .pivot = vector(0.5)};
        if (k % 2 == 0)
            motion.oscillations.push_back({.amplitude = vector(0.1),
                                           .swing = vector(0.2),
                                           .frequency = random.uniform(1, 5),
                                           .phase = random.uniform(-180, 180)});
        if (k % 3 == 0)
            motion.keyframes = {
                {.time = 0.4, .translation = vector(0.5), .rotation = {.axis = vector(1), .degrees = 200}},
                {.time = 1, .translation = vector(0.5), .rotation = {.axis = vector(1), .degrees = -100}}};
        obstacle.motion = motion;
        const double most = obstacle.largestSpeed({});
        double fastest = 0;
        constexpr double h = 1e-5;
        for (int step = 0; step < 200; ++step) {
            const double time = random.uniform(0, 1);
            const glm::dvec3 corner(k % 2 == 0 ? 0.3 : -0.3, step % 2 == 0 ? 0.2 : -0.2, step % 3 == 0 ? 0.1 : -0.1);
            const glm::dvec3 way =
                motion.poseAt(time + h).frame().outside(corner) - motion.poseAt(time).frame().outside(corner);
            fastest = std::max(fastest, glm::length(way) / h);
        }
        EXPECT_LT(fastest, most * (1 + 1e-3)) << k;
        EXPECT_GT(fastest, 0.1 * most) << k;
    }
}

// A described scene is the same scene from then on.
TEST(SceneMotion, GoesOnInADescribedScene) {
    const Scene scene = *build(parsed(withMotion(R"("velocity": [0.1, 0, 0], "spin": [0, 0, 1], "pivot": [5, 5, 4],
        "oscillations": [{"amplitude": [0, 0, 0.1], "frequency": 1, "phase": 30}], "belt": [0, 1, 0], "begin": 0.5, "duration": 9,
        "keyframes": [{"time": 2, "translation": [0, 0, 1], "rotation": {"axis": [0, 1, 0], "degrees": 20}}])")));
    v1::Scene message = describe(scene, 1.5);
    message.clear_groups();
    const auto later = build(message);
    ASSERT_TRUE(later) << later.error().text();
    for (const double time : {0.0, 0.7, 2.0, 20.0}) {
        const Frame expected = scene.obstacles[0].motion->poseAt(1.5 + time).frame();
        const Frame frame = later->obstacles[0].motion->poseAt(time).frame();
        expectNear(frame.outside({5, 6, 7}), expected.outside({5, 6, 7}));
    }
    expectNear(later->obstacles[0].motion->belt, {0, 1, 0});
}

TEST(SceneMotion, RefusesWhatCannotBe) {
    EXPECT_EQ(refusalOfMotion(R"("acceleration": [1, 0, 0])"),
              "obstacles[0].motion.duration: is missing, but `acceleration` needs one: the speed would grow for ever");
    EXPECT_EQ(refusalOfMotion(R"("oscillations": [{"amplitude": [1, 0, 0]}])"),
              "obstacles[0].motion.oscillations[0].frequency: is 0, must be positive");
    EXPECT_EQ(refusalOfMotion(R"("keyframes": [{"time": 2}, {"time": 1}])"),
              "obstacles[0].motion.keyframes[1].time: is 1 s, must be above 2 s, the time before");
    EXPECT_EQ(
        refusalOfMotion(R"("keyframes": [{"time": 2, "translation": [0, 0, 1]}], "repeat": true)"),
        "obstacles[0].motion.repeat: is true, but the last keyframe is not where the obstacle began: it would jump "
        "back; add a keyframe without translation and rotation");
    EXPECT_EQ(refusalOfMotion(R"("keyframes": [{"time": 2, "rotation": {"axis": [0, 0, 0], "degrees": 9}}])"),
              "obstacles[0].motion.keyframes[0].rotation.axis: is zero, must have a direction");
    EXPECT_EQ(refusalOfMotion(R"("spin": [1, 0])"),
              "obstacles[0].motion.spin: has 2 numbers, must have three: x, y, z");
    EXPECT_NE(refusalOfMotion(R"("velocity": [1e6, 0, 0])")
                  .find("moves its surface at up to 1e+06 m/s; with a smallest radius of 0.1 m, the scene can compute"),
              std::string::npos)
        << refusalOfMotion(R"("velocity": [1e6, 0, 0])");
    EXPECT_NE(refusalOfMotion(R"("velocity": [1e300, 0, 0])").find("obstacles[0].motion.velocity[0]: is 1e+300"),
              std::string::npos);
}

// A command moves an obstacle from where it is at that moment.
TEST(SceneMotion, IsReplacedByAMove) {
    Scene scene = *build(parsed(withMotion(R"("velocity": [1, 0, 0], "spin": [0, 0, 1], "pivot": [5, 5, 5])",
                                           R"("box": {"min": [-1,-2,-1], "max": [1,2,1]}, "translation": [5, 5, 5])")));
    scene.time = pi / 2;
    v1::MoveObstacle move;
    const Obstacle stopped = *movedObstacle(move, scene);
    EXPECT_FALSE(stopped.motion);
    // It has turned by a right angle, so that its long side lies along x.
    const double x = 5 + scene.time;
    EXPECT_NEAR(stopped.distance({x + 3, 5, 5}, 0), 1, 1e-12);
    EXPECT_NEAR(stopped.distance({x, 7, 5}, 99), 1, 1e-12);
    setVector(*move.mutable_by(), {0, 0, 1});
    move.mutable_turn()->mutable_axis()->Add(1);
    move.mutable_turn()->mutable_axis()->Add(0);
    move.mutable_turn()->mutable_axis()->Add(0);
    move.mutable_turn()->set_degrees(90);
    setVector(*move.mutable_motion()->mutable_velocity(), {0, 1, 0});
    const Obstacle moved = *movedObstacle(move, scene);
    EXPECT_NEAR(moved.distance({x + 3, 5, 6}, scene.time), 1, 1e-12);
    EXPECT_NEAR(moved.distance({x + 3, 7, 6}, scene.time + 2), 1, 1e-12);
    EXPECT_NEAR(moved.distance({x + 3, 5, 6}, scene.time - 1), 1, 1e-12);
    move.mutable_by()->Add(1);
    EXPECT_EQ(movedObstacle(move, scene).error().text(), "by: has 4 numbers, must have three: x, y, z");
}

// Spheres are placed beside obstacles as they are at the scene's time.
TEST(SceneMotion, PlacesSpheresBesideObstacles) {
    Scene scene = *build(parsed(withMotion(R"("velocity": [1, 0, 0])")));
    EXPECT_TRUE(obstacleAt(scene, {5, 5, 5}, 0.1));
    EXPECT_FALSE(obstacleAt(scene, {8, 5, 5}, 0.1));
    scene.time = 3;
    EXPECT_FALSE(obstacleAt(scene, {5, 5, 5}, 0.1));
    EXPECT_TRUE(obstacleAt(scene, {8, 5, 5}, 0.1));
}

TEST(SceneMotion, OfADriveIsItsPlaceUntilAForceChangesIt) {
    const Motion slide = motionFrom(R"("drive": {"along": [0, 3, 4], "mass": 2, "mostSpeed": 5, "most": 1,
                                                 "place": 0.5, "rate": 0.25})");
    expectNear(slide.poseAt(1).shift, {0, 0.45, 0.6});
    expectNear(slide.poseAt(100).shift, {0, 0.6, 0.8});  // it does not pass its stop
    EXPECT_EQ(slide.speeds().pivot, 5);
    EXPECT_EQ(slide.drive->forceAt({0, 0, -10}, {}), -16);
    const Motion turn = motionFrom(R"("pivot": [5, 5, 5], "drive": {"about": [0, 2, 0], "inertia": 3, "torque": 1,
                                      "mass": 2, "centre": [5, 5, 4], "mostSpeed": 9, "place": 1.5707963267948966})");
    expectNear(turn.poseAt(3).frame().outside({5, 5, 4}), {4, 5, 5});
    EXPECT_EQ(turn.speeds().turn, 9);
    EXPECT_NEAR(turn.drive->forceAt({0, 0, -10}, turn.pivot), 1 - 20, 1e-9);
    EXPECT_FALSE(turn.staysInPlace());
}

TEST(SceneMotion, OfADriveIsRefusedWithTheReason) {
    const std::string at = "obstacles[0].motion.drive";
    const std::pair<const char*, std::string> cases[] = {
        {R"("drive": {})", at + ": needs `along`, to slide, or `about`, to turn"},
        {R"("drive": {"along": [1,0,0], "about": [1,0,0]})",
         at + ": has both `along` and `about`; a body slides or turns"},
        {R"("drive": {"along": [0,0,0], "mass": 1, "mostSpeed": 1})", at + ".along: has length zero"},
        {R"("drive": {"along": [1,0,0], "mass": 1})", at + ".mostSpeed: is 0, must be positive"},
        {R"("drive": {"along": [1,0,0], "mostSpeed": 1})", at + ".mass: is 0, must be 1e-12 to 1000000000000 kg"},
        {R"("drive": {"about": [1,0,0], "mostSpeed": 1})",
         at + ".inertia: is 0, must be 1e-12 to 1000000000000 kg m^2"},
        {R"("drive": {"along": [1,0,0], "mass": 1, "torque": 1, "mostSpeed": 1})",
         at + ".torque: is of a body that turns; this one slides (`along`)"},
        {R"("drive": {"about": [1,0,0], "inertia": 1, "force": 1, "mostSpeed": 1})",
         at + ".force: is of a body that slides; this one turns (`about`)"},
        {R"("drive": {"along": [1,0,0], "mass": 1, "mostSpeed": 1, "least": 2, "most": 1})",
         at + ".most: is 1 m, must be at least 2, the value of `least`"},
        {R"("drive": {"along": [1,0,0], "mass": 1, "mostSpeed": 1, "rate": 2})",
         at + ".rate: is 2, must be -1 to 1 m/s"},
        {R"("velocity": [1,0,0], "drive": {"along": [1,0,0], "mass": 1, "mostSpeed": 1})",
         at + ": is beside a prescribed motion; only `pivot` and `belt` go with it"},
    };
    for (const auto& [motion, refusal] : cases) EXPECT_EQ(refusalOfMotion(motion), refusal);
}

}  // namespace
}  // namespace spherule::scene::testing
