#pragma once

#include <cstdint>
#include <optional>

#include "compute/device.h"
#include "scene/scene.h"
#include "sim/state.h"

namespace spherule::sim {

// The overlap, in radii, up to which the scene's model makes no speed of pushing spheres apart. For the springs of
// `accurate` it is that of the fastest impact to expect: deeper ones hold more energy than anything in the scene.
double deepestBearable(const scene::Scene& scene);

struct Relaxed {
    State state;  // in new places, with the old velocities
    std::uint32_t sweeps = 0;
    double overlap = 0;  // the largest that is left, in smaller radii
};

// Pushes spheres apart by position alone, without gravity or friction and within the walls, until no overlap is larger
// than `most` or many sweeps have passed. No time passes. Needs memory for a simulation of its own meanwhile.
Result<Relaxed> relax(compute::Device& device, const scene::Scene& scene, const State& state, double most);

}  // namespace spherule::sim
