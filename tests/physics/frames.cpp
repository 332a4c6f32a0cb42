#include "frames.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>

#include "measure/scenes.h"
#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::physics {

namespace {

// Returns the rotation about `axis` (unit length) by `angle` (Rodrigues).
glm::dmat3 rotation(const glm::dvec3& axis, double angle) {
    glm::dmat3 matrix;
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 unit(0);
        unit[k] = 1;
        matrix[k] =
            std::cos(angle) * unit + std::sin(angle) * glm::cross(axis, unit) + (1 - std::cos(angle)) * axis[k] * axis;
    }
    return matrix;
}

void rotateBounds(scene::Scene& scene, const Frame& frame) {
    scene::Bounds& bounds = scene.bounds;
    for (unsigned face = 0; face < 6; ++face) {
        if (std::exchange(bounds.open[face], true)) continue;
        glm::dvec3 normal(0);
        normal[static_cast<int>(face / 2)] = face % 2 == 0 ? 1 : -1;
        const glm::dvec3& corner = face % 2 == 0 ? bounds.min : bounds.max;
        scene.obstacles.push_back({scene::planeShape(glm::dot(corner, normal) * normal, normal), bounds.material, ""});
    }
    const double reach = glm::length(bounds.max);
    bounds.min = glm::dvec3(-reach);
    bounds.max = glm::dvec3(reach);
    for (scene::Obstacle& obstacle : scene.obstacles) {
        const std::optional<glm::dvec3> normal = obstacle.shape->normalOfHalfSpace();
        if (!normal) throw std::invalid_argument("only planes can be rotated");
        const glm::dvec3 point = -obstacle.shape->distance(glm::dvec3(0)) * *normal;
        obstacle.shape = scene::planeShape(frame.turn * point, frame.turn * *normal);
    }
}

void scaleObstacle(scene::Obstacle& obstacle, double scale) {
    v1::Obstacle message;
    obstacle.shape->write(message);
    if (message.has_plane()) {
        for (double& value : *message.mutable_plane()->mutable_point()) value *= scale;
    } else {
        for (double& value : *message.mutable_box()->mutable_min()) value *= scale;
        for (double& value : *message.mutable_box()->mutable_max()) value *= scale;
    }
    scene::Check check;
    obstacle.shape = scene::readShape(check, message, "obstacle");
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Frame& frame) {
    return out << frame.name;
}

Frame atRest() {
    return {};
}

Frame moving() {
    return {.name = "Moving", .drift = {6, 0, -8}};
}

Frame rotated() {
    return {.name = "Rotated", .turn = rotation(glm::dvec3(1, 2, 2) / 3.0, std::numbers::pi / 6)};
}

Frame scaled() {
    return {.name = "Scaled", .scale = std::ldexp(1.0, -9)};
}

Frame falling() {
    return {.name = "Falling", .gravity = {0, 0, -measure::earth}};
}

scene::Scene inFrame(scene::Scene scene, const Frame& frame, double seconds) {
    if (frame.turn != glm::dmat3(1)) rotateBounds(scene, frame);
    scene.bounds.min *= frame.scale;
    scene.bounds.max *= frame.scale;
    for (scene::Obstacle& obstacle : scene.obstacles) scaleObstacle(obstacle, frame.scale);
    for (scene::Sphere& sphere : scene.spheres) {
        sphere.position = frame.scale * (frame.turn * sphere.position - 0.5 * seconds * frame.drift);
        sphere.velocity = glm::vec3(frame.turn * glm::dvec3(sphere.velocity) + frame.drift);
        sphere.radius *= static_cast<float>(frame.scale);
        sphere.spin = glm::vec3(frame.turn * glm::dvec3(sphere.spin) / frame.scale);
    }
    scene.forces.gravity = (frame.turn * scene.forces.gravity + frame.gravity) / frame.scale;
    scene.step *= frame.scale;
    return scene;
}

Moments momentsOf(const sim::State& state) {
    Moments sum;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const double mass = massOf(state, id);
        sum.mass += mass;
        sum.centre += mass * positionOf(state, id);
        sum.momentum += mass * velocityOf(state, id);
    }
    sum.centre /= sum.mass;
    const glm::dvec3 drift = sum.momentum / sum.mass;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const double mass = massOf(state, id);
        const glm::dvec3 velocity = velocityOf(state, id) - drift;
        const glm::dvec3 orbital = mass * glm::cross(positionOf(state, id) - sum.centre, velocity);
        const glm::dvec3 own = 0.4 * mass * radiusOf(state, id) * radiusOf(state, id) * spinOf(state, id);
        sum.angular += orbital + own;
        sum.angularScale += glm::length(orbital) + glm::length(own);
        sum.kinetic += 0.5 * (mass * glm::dot(velocity, velocity) + glm::dot(own, spinOf(state, id)));
    }
    return sum;
}

double kineticEnergyIn(const sim::State& state) {
    return momentsOf(state).kinetic;
}

double meanHeightOf(const sim::State& state, const Frame& frame, double floor) {
    return frame.inside(momentsOf(state).centre).z / frame.scale - floor;
}

}  // namespace spherule::physics
