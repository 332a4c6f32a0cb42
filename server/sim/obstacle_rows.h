#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "scene/shapes.h"
#include "sim/layout.h"
#include "sim/pipeline.h"

namespace spherule::sim {

struct MeshTables;

// A substep or a step, in s simulated.
struct TimeSpan {
    double begin = 0;
    double end = 0;
};

// The rows of the array Obstacles: each obstacle, then the motion of each obstacle that may move.
class ObstacleRows {
  public:
    // `meshes`: of the plan; null if there are none.
    ObstacleRows(const scene::Scene& scene, const MeshTables* meshes);

    // Sets the frames and motions in a substep: see shaders/shared/layout.h. `framesAt`: its begin, or its end (s).
    void place(const scene::Scene& scene, const TimeSpan& times, double framesAt);

    [[nodiscard]] const std::vector<layout::Obstacle>& rows() const { return rows_; }
    // Returns true if an obstacle has a motion.
    [[nodiscard]] bool anyMoves() const { return !moving_.empty(); }
    // Returns the largest speed of a surface at any time (m/s), of obstacles that move during `times`.
    [[nodiscard]] double fastestIn(const scene::Scene& scene, const TimeSpan& times) const;
    // Writes the rows that a motion changes.
    void upload(Pipeline& pipeline) const;

  private:
    struct Moving {
        std::size_t obstacle = 0;
        scene::Frame local{};     // of the shape, relative to the pivot
        double largestSpeed = 0;  // of a point of its surface, m/s
        std::uint32_t drive = 0;  // the first row of its sums; 0: it has no drive
    };

    glm::dvec3 centre_;  // m: of the bounds
    std::vector<layout::Obstacle> rows_;
    std::vector<Moving> moving_;
};

}  // namespace spherule::sim
