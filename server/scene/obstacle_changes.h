#pragma once

#include "core/result.h"
#include "scene/scene.h"

namespace spherule::v1 {
class MoveObstacle;
class Obstacle;
}  // namespace spherule::v1

// Changes of the obstacles of a scene while it runs, at scene.time. The errors' `where` begins at the message.
namespace spherule::scene {

// Returns the obstacle of the message.
Result<Obstacle> obstacleToAdd(const v1::Obstacle& message, const Scene& scene);

// Returns an obstacle of the scene after the move.
Result<Obstacle> movedObstacle(const v1::MoveObstacle& message, const Scene& scene);

// Refuses obstacles that a scene cannot have: too many, too fast, too large, or not along periodic axes.
Result<void> checkObstacles(const Scene& scene);

}  // namespace spherule::scene
