#pragma once

#include <cstdint>

#include <string>

#include "compute/device.h"
#include "trajectories.h"

namespace spherule::bench {

// Median wall times of a frame in ms, of spheres that all move, each in a way of its own.
struct CodecSpeed {
    double fastest = 0;   // of the encoder
    double encode = 0;    // all passes, positions gathered through order and slots
    double keyframe = 0;  // of the state
    double hash = 0;      // on top of either
    double decode = 0;    // here, in one thread
    double bytes = 0;     // per sphere
};

// The error is the smallest radius over `ratio`. Ids are those of a lattice, or `shuffled`, which costs the gather more
// than any mixing can. Writes the frames, and the ids in their order, into the folder `keep` unless that is empty;
// throws what goes wrong as std::runtime_error.
CodecSpeed codecSpeed(compute::Device& device, std::uint32_t spheres, double ratio, bool shuffled,
                      const std::string& keep);
// The same of copies of a bed, from the first frame of the trajectory on.
CodecSpeed codecSpeed(compute::Device& device, std::uint32_t spheres, double ratio, const Trajectory& bed,
                      const std::string& keep);

}  // namespace spherule::bench
