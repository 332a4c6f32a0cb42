#pragma once

#include <cstdint>

#include <string>

#include "compute/device.h"
#include "trajectories.h"

namespace spherule::bench {

// Median wall times of a frame (ms). All spheres move, each with its own velocity.
struct CodecSpeed {
    double fastest = 0;   // encode time of the fastest frame
    double encode = 0;    // all passes; positions are gathered through order and slots
    double keyframe = 0;  // keyframe of the present state
    double hash = 0;      // added to `encode` by the hash
    double decode = 0;    // on the host, in one thread
    double bytes = 0;     // of the last frame, per sphere
};

// The largest error is the smallest radius / `ratio`. Ids number a lattice, or are `shuffled`: the worst case of the
// gather. Writes the frames and their order of ids to the folder `keep`, unless it is empty. Throws
// std::runtime_error.
CodecSpeed codecSpeed(compute::Device& device, std::uint32_t spheres, double ratio, bool shuffled,
                      const std::string& keep);
// Same as above, with copies of a bed; starts at the first frame of the trajectory.
CodecSpeed codecSpeed(compute::Device& device, std::uint32_t spheres, double ratio, const Trajectory& bed,
                      const std::string& keep);

}  // namespace spherule::bench
