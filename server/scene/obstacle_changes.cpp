#include "scene/obstacle_changes.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

#include "scene/load.h"
#include "scene/periodic_axes.h"
#include "scene/quality.h"
#include "scene/shapes.h"
#include "scene/surroundings.h"
#include "spherule/v1/scene_parts.pb.h"

namespace spherule::scene {

namespace {

// The message counts from now.
void startAt(Obstacle& obstacle, double time) {
    if (!obstacle.motion) return;
    if (obstacle.motion->drive)
        obstacle.motion->drive->since = time;
    else
        obstacle.motion->begin += time;
}

}  // namespace

Result<Obstacle> obstacleToAdd(const v1::Obstacle& message, const Scene& scene) {
    Check check;
    const glm::dvec3 side = scene.bounds.max - scene.bounds.min;
    const ShapeInput input{.longestSide = std::max({side.x, side.y, side.z})};
    Obstacle obstacle = readObstacle(check, message, scene.materials, input, "obstacle");
    if (!check.ok()) return check.error();
    startAt(obstacle, scene.time);
    return obstacle;
}

Result<Obstacle> movedObstacle(const v1::MoveObstacle& message, const Scene& scene) {
    Check check;
    Obstacle moved = scene.obstacles.at(message.obstacle());
    if (moved.motion) moved.shape = movedShape(moved.shape, moved.motion->poseAt(scene.time).frame());
    const glm::dvec3 by = check.vectorOr(message.by(), {}, "by");
    Rotation turn;
    if (message.has_turn()) turn = readRotation(check, message.turn(), "turn");
    const Pose pose{.turn = turn.quaternion(), .pivot = originOf(*moved.shape), .shift = by};
    if (message.has_turn() || by != glm::dvec3(0)) moved.shape = movedShape(moved.shape, pose.frame());
    moved.motion.reset();
    if (message.has_motion()) moved.motion = readMotion(check, message.motion(), originOf(*moved.shape), "motion");
    if (!check.ok()) return check.error();
    startAt(moved, scene.time);
    return moved;
}

Result<void> checkObstacles(const Scene& scene) {
    Check check;
    const std::size_t count = scene.obstacles.size();
    if (count > maxObstacles)
        check.refuse("obstacle", fmt::format("is one too many, a scene has at most {}", maxObstacles));
    if (count * scene.spheres.size() > maxObstaclePairs)
        check.refuse("obstacle",
                     fmt::format("is one too many: {} spheres and {} obstacles are {} pairs, but a scene "
                                 "holds at most {}",
                                 scene.spheres.size(), count, count * scene.spheres.size(), maxObstaclePairs));
    if (const double smallest = smallestRadiusIn(scene); check.ok() && smallest > 0)
        checkResolution(check, scene, smallest, "bounds");
    checkMeshParts(check, scene.obstacles);
    if (!check.ok()) return check.error();
    if (auto fits = checkPeriodicAxes(scene); !fits) return fits;
    return checkObstacleSpeeds(scene);
}

}  // namespace spherule::scene
