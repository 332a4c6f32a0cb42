#include "scene/view.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace spherule::scene {

Camera framing(const Bounds& bounds, double fieldOfView) {
    constexpr double aspect = 1.5;
    constexpr double margin = 1.05;
    const glm::dvec3 forward = glm::normalize(glm::dvec3(-0.45, 1, -0.4));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
    const glm::dvec3 up = glm::cross(right, forward);
    const double slope = std::tan(0.5 * glm::radians(fieldOfView));
    // The nearest distance at which every corner lies within the four sides of the picture.
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point((corner & 1) != 0 ? bounds.max.x : bounds.min.x,
                               (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                               (corner & 4) != 0 ? bounds.max.z : bounds.min.z);
        const glm::dvec3 p = point - bounds.centre();
        const double across = std::abs(glm::dot(p, right)) / (slope * aspect);
        const double upwards = std::abs(glm::dot(p, up)) / slope;
        distance = std::max(distance, std::max(across, upwards) - glm::dot(p, forward));
    }
    return {bounds.centre() - margin * distance * forward, bounds.centre(), fieldOfView};
}

Camera readCamera(Check& check, const v1::Camera& message, const Bounds& bounds) {
    const double fieldOfView = message.has_field_of_view()
                                   ? check.within(message.field_of_view(), 1, 150, "camera.fieldOfView", " degrees")
                                   : Camera{}.fieldOfView;
    if (!check.ok()) return {};
    Camera camera = framing(bounds, fieldOfView);
    camera.eye = check.vectorOr(message.eye(), camera.eye, "camera.eye");
    camera.target = check.vectorOr(message.target(), camera.target, "camera.target");
    if (check.ok() && camera.eye == camera.target)
        check.refuse("camera.target", "is where the eye is; move one of them");
    return camera;
}

Light readLight(Check& check, const v1::Light& message) {
    constexpr double strongest = 10;
    Light light;
    if (!message.direction().empty()) {
        check.part([&] {
            const glm::dvec3 direction = check.vector(message.direction(), "light.direction");
            if (direction == glm::dvec3(0)) check.refuse("light.direction", "has no length");
            if (check.ok()) light.direction = glm::normalize(direction);
        });
    }
    if (message.has_strength()) light.strength = check.within(message.strength(), 0, strongest, "light.strength");
    light.colour = check.colour(message.colour(), "light.colour");
    if (message.has_sky()) light.sky = check.within(message.sky(), 0, strongest, "light.sky");
    return light;
}

v1::Light messageOf(const Light& light) {
    v1::Light message;
    if (light.direction) setVector(*message.mutable_direction(), *light.direction);
    message.set_strength(light.strength);
    message.set_colour(light.colour);
    message.set_sky(light.sky);
    return message;
}

}  // namespace spherule::scene
