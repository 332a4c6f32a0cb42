#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "recording/recording.h"

namespace spherule::recording {

// Follows the spheres of a recording across the seams of periodic axes, from snapshot to snapshot. A sphere that moves
// by more than half a length between two snapshots is taken for one that moves the other way. Used by one thread.
class Unwrapper {
  public:
    // Takes the next snapshot. Returns the positions by id (m), valid until the next call: they are as in the first
    // snapshot of a scene, and go on from there without jumps.
    std::span<const glm::dvec3> follow(const Snapshot& snapshot);

  private:
    std::vector<glm::dvec3> positions_;
    std::uint64_t scene_ = 0;  // Snapshot::scene of the positions
};

}  // namespace spherule::recording
