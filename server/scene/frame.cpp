#include "scene/frame.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

Rotation Rotation::of(const glm::dquat& turn) {
    const glm::dvec3 axis(turn.x, turn.y, turn.z);
    const double sine = glm::length(axis);
    if (!(sine > 0)) return {};
    return {.axis = axis / sine, .degrees = glm::degrees(2 * std::atan2(sine, turn.w))};
}

glm::dquat Rotation::quaternion() const {
    return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
}

Rotation readRotation(Check& check, const v1::Rotation& message, const std::string& field) {
    Rotation rotation{.axis = check.vector(message.axis(), at(field, "axis")),
                      .degrees = check.within(message.degrees(), -360, 360, at(field, "degrees"), "°")};
    if (!(glm::length(rotation.axis) > 0)) {
        check.refuse(at(field, "axis"), "is zero, must have a direction");
        rotation.axis = {0, 0, 1};
    }
    return rotation;
}

void writeRotation(v1::Rotation& message, const Rotation& rotation) {
    setVector(*message.mutable_axis(), rotation.axis);
    message.set_degrees(rotation.degrees);
}

}  // namespace spherule::scene
