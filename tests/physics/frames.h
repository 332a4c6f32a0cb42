#pragma once

#include <ostream>
#include <string>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "scene/scene.h"
#include "sim/state.h"

// One scene in several frames: a law of contacts gives the same motion in each.
namespace spherule::physics {

struct Frame {
    std::string name = "AtRest";
    glm::dmat3 turn{1.0};  // rotation of the scene and its gravity
    glm::dvec3 drift{};    // velocity added to all spheres, m/s
    glm::dvec3 gravity{};  // gravity added for a scene in free fall, m/s^2
    double scale = 1;      // of lengths and times; velocities stay

    [[nodiscard]] glm::dvec3 inside(const glm::dvec3& vector) const { return glm::transpose(turn) * vector; }
};

std::ostream& operator<<(std::ostream& out, const Frame& frame);  // its name

Frame atRest();
Frame moving();   // at 10 m/s
Frame rotated();  // by 30 degrees about an oblique axis
Frame scaled();   // by 2^-9
Frame falling();  // with the earth's gravity

// Returns the scene in the frame. A scene that drifts crosses the middle after `seconds` / 2. Closed faces become
// planes if the frame rotates them. The scene has its middle at the origin, and no boxes if the frame rotates them.
scene::Scene inFrame(scene::Scene scene, const Frame& frame, double seconds = 0);

// Sums over spheres, relative to their centre of mass and to its velocity.
struct Moments {
    double mass = 0;          // kg
    glm::dvec3 centre{};      // m
    glm::dvec3 momentum{};    // N s
    glm::dvec3 angular{};     // N m s, with spin
    double angularScale = 0;  // sum of |m x v| and of the spins' share
    double kinetic = 0;       // J, with rotation
};
Moments momentsOf(const sim::State& state);
double kineticEnergyIn(const sim::State& state);  // Moments::kinetic

// Returns the height (m) of the centre of mass above a floor at `floor` in the scene before inFrame(). The result has
// the lengths of that scene.
double meanHeightOf(const sim::State& state, const Frame& frame, double floor);

}  // namespace spherule::physics
