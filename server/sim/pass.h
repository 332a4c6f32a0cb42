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
    ContactMemory,
    Impulses,  // of `fast`
    WallImpulses,
    Begin,  // of `balanced`
    Contacts,
    Finish,
    Forces,  // of `accurate`
    WallForces,
    Sleep,
    Statistics,
    Pack,
};

constexpr unsigned passCount = 14;

std::string_view nameOf(Pass pass);

}  // namespace spherule::sim
