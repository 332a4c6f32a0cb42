#pragma once

#include <string>
#include <vector>

#include "compute/device.h"
#include "trajectories.h"

namespace spherule::bench {

// Bytes per sphere and frame of one codec over a trajectory, payload only.
struct CodecSize {
    std::string codec;
    std::string trajectory;
    double ratio = 0;  // the error is the smallest radius over this, per axis
    double bytes = 0;
};

// Of ours in order of ids and in Morton order frozen at the first frame (with that of a keyframe), and of the rivals in
// the latter. Whatever ours makes is decoded again and compared; throws where it differs.
std::vector<CodecSize> codecSizes(compute::Device& device, const Trajectory& trajectory, double ratio);

}  // namespace spherule::bench
