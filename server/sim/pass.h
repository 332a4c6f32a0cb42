#pragma once

#include <cstdint>
#include <string_view>

namespace spherule::sim {

// The passes of a substep in their order, then the passes that run on demand. Their names label timers, metrics and
// rows of the plan.
enum class Pass : std::uint8_t {
    Integrate,
    Grid,
    Lists,
    SlipMemory,  // of `accurate`
    Impulses,    // of `fast`
    WallImpulses,
    Positions,  // of `balanced`
    WallPositions,
    Velocities,
    WallVelocities,
    Friction,
    WallFriction,
    Forces,  // of `accurate`
    WallForces,
    Sleep,
    Statistics,
    Pack,
};

constexpr unsigned passCount = 17;

std::string_view nameOf(Pass pass);

}  // namespace spherule::sim
