#include "sim/picking.h"

#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

namespace spherule::sim {

namespace {

// Returns the places at which a sphere is seen: its position, and its images that reach into the bounds.
std::vector<glm::dvec3> imagesOf(const glm::dvec3& centre, double radius, const glm::dvec3& periods) {
    std::vector<glm::dvec3> places{centre};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(periods[axis] > 0)) continue;
        const double half = 0.5 * periods[axis];
        const std::size_t before = places.size();
        for (const double side : {1.0, -1.0}) {
            if (centre[axis] * side - radius > -half) continue;
            for (std::size_t k = 0; k < before; ++k) {
                places.push_back(places[k]);
                places.back()[axis] += side * periods[axis];
            }
        }
    }
    return places;
}

}  // namespace

std::optional<std::uint32_t> firstHit(const State& state, glm::dvec3 origin, glm::dvec3 direction,
                                      const glm::dvec3& periods) {
    std::optional<std::uint32_t> hit;
    double nearest = std::numeric_limits<double>::infinity();
    const auto look = [&](std::uint32_t id, const glm::dvec3& centre) {
        const glm::dvec3 to = centre - origin;
        const auto r = static_cast<double>(state.position[id].w);
        const double along = glm::dot(to, direction);
        const double discriminant = r * r - (glm::dot(to, to) - along * along);
        if (!(discriminant >= 0)) return;
        const double entry = along - std::sqrt(discriminant);
        const double exit = along + std::sqrt(discriminant);
        if (exit < 0 || entry >= nearest) return;
        nearest = entry;
        hit = id;
    };
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        if (state.images.empty()) {
            look(id, positionOf(state, id));
            continue;
        }
        for (const glm::dvec3& place : imagesOf(positionOf(state, id), radiusOf(state, id), periods)) look(id, place);
    }
    return hit;
}

}  // namespace spherule::sim
