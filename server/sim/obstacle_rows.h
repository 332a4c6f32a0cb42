#pragma once

#include <cstddef>
#include <vector>

#include "scene/scene.h"
#include "scene/shapes.h"
#include "sim/layout.h"
#include "sim/pipeline.h"

namespace spherule::sim {

struct MeshTables;

// A substep, in s simulated.
struct SubstepTimes {
    double begin = 0;
    double end = 0;
};

// The rows of the array Obstacles: each obstacle, then the motion of each obstacle that may move.
class ObstacleRows {
  public:
    // `meshes`: of the plan; null if there are none.
    ObstacleRows(const scene::Scene& scene, const MeshTables* meshes);

    // Sets the frames and motions in a substep: see shaders/shared/layout.h. `framesAt`: its begin, or its end (s).
    void place(const scene::Scene& scene, const SubstepTimes& times, double framesAt);

    [[nodiscard]] const std::vector<layout::Obstacle>& rows() const { return rows_; }
    // Returns true if an obstacle has a motion.
    [[nodiscard]] bool anyMoves() const { return !moving_.empty(); }
    // Writes the rows that a motion changes.
    void upload(Pipeline& pipeline) const;

  private:
    struct Moving {
        std::size_t obstacle = 0;
        scene::Frame local{};  // of the shape, relative to the pivot
    };

    glm::dvec3 centre_;  // m: of the bounds
    std::vector<layout::Obstacle> rows_;
    std::vector<Moving> moving_;
};

}  // namespace spherule::sim
