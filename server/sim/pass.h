#pragma once

#include <cstdint>
#include <string_view>

namespace spherule::sim {

// The passes of a substep in their order, then those that run on demand. Names timers, metrics and rows of the plan.
enum class Pass : std::uint8_t {
    Integrate,
    Grid,
    Lists,
    Positions,
    WallPositions,
    Velocities,
    WallVelocities,
    Sleep,
    Statistics,
    Pack,
};

constexpr unsigned passCount = 10;

std::string_view nameOf(Pass pass);

}  // namespace spherule::sim
