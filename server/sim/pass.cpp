#include "sim/pass.h"

#include <array>

namespace spherule::sim {

std::string_view nameOf(Pass pass) {
    static constexpr std::array<std::string_view, passCount> names = {
        "integrate", "grid",   "lists",  "contact-memory", "impulses", "wall-impulses", "begin",
        "contacts",  "finish", "forces", "wall-forces",    "sleep",    "statistics",    "pack",
    };
    return names.at(static_cast<std::size_t>(pass));
}

}  // namespace spherule::sim
