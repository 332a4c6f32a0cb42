#pragma once

#include <glm/vec3.hpp>

namespace spherule::scene {

struct Box {
    glm::dvec3 min{};
    glm::dvec3 max{};

    // The faces belong to the box.
    [[nodiscard]] bool contains(const glm::dvec3& p) const {
        return p.x >= min.x && p.y >= min.y && p.z >= min.z && p.x <= max.x && p.y <= max.y && p.z <= max.z;
    }
};

}  // namespace spherule::scene
