#include "sim/picking.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace spherule::sim {

std::optional<std::uint32_t> firstHit(const State& state, glm::dvec3 origin, glm::dvec3 direction) {
    std::optional<std::uint32_t> hit;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const glm::dvec3 to = glm::dvec3(state.position[id]) - origin;
        const auto r = static_cast<double>(state.position[id].w);
        const double along = glm::dot(to, direction);
        const double discriminant = r * r - (glm::dot(to, to) - along * along);
        if (!(discriminant >= 0)) continue;
        const double entry = along - std::sqrt(discriminant);
        const double exit = along + std::sqrt(discriminant);
        if (exit < 0 || entry >= nearest) continue;
        nearest = entry;
        hit = id;
    }
    return hit;
}

}  // namespace spherule::sim
