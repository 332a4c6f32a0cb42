#pragma once

#include <limits>
#include <string>

#include <glm/vec3.hpp>

namespace spherule::v1 {
class Drive;
}

namespace spherule::scene {

class Check;

// A body with one degree of freedom, which a force, its weight and the spheres move: see v1::Drive. Its place is along
// the axis in m, or about it in rad.
struct Drive {
    glm::dvec3 axis{0, 0, 1};  // of unit length
    bool turns = false;        // about the axis through the pivot; otherwise it slides along the axis
    double mass = 0;           // kg; of a body that turns, only for its weight
    double inertia = 1;        // kg, the mass; kg m^2 if it turns
    double force = 0;          // N; N m if it turns
    glm::dvec3 centre{};       // m: the centre of mass at place 0, of a body that turns
    double damping = 0;        // N s/m; N m s if it turns
    double mostRate = 1;       // m/s or rad/s
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    // The state, which the simulation continues.
    double place = 0;
    double rate = 0;   // m/s or rad/s
    double since = 0;  // s simulated: the time of the state

    // Returns the place at a time at which no force has changed its rate since.
    [[nodiscard]] double placeAt(double time) const;
    // Returns the force along the axis (N), or the moment about it (N m), of the drive and of its weight.
    [[nodiscard]] double forceAt(const glm::dvec3& gravity, const glm::dvec3& pivot) const;
};

// `pivot`: of the motion (m).
Drive readDrive(Check& check, const v1::Drive& message, const glm::dvec3& pivot, const std::string& field);
void writeDrive(v1::Drive& message, const Drive& drive);

}  // namespace spherule::scene
