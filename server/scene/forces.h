#pragma once

#include <glm/vec3.hpp>

namespace spherule::scene {

// The forces on every sphere besides contacts. This file is the only one that reads them from a scene.
struct Forces {
    glm::dvec3 gravity{};  // m/s^2

    // Reads the forces of a v1::Scene. A template, so that users of a Scene need neither messages nor Check.
    template <class Check, class Message>
    static Forces read(Check& check, const Message& message) {
        return {.gravity = check.vectorOr(message.gravity(), {0, 0, -9.81}, "gravity")};
    }
};

}  // namespace spherule::scene
