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
    double ratio = 0;  // largest error per axis = smallest radius / ratio
    double bytes = 0;
};

// Sizes of our codec by id and in the Morton order of the first frame, with a keyframe in the latter. Rivals use the
// Morton order too. Decodes each frame of ours and compares it; throws if it differs.
std::vector<CodecSize> codecSizes(compute::Device& device, const Trajectory& trajectory, double ratio);

}  // namespace spherule::bench
