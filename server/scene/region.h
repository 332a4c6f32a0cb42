#pragma once

#include <string>
#include <variant>

#include <glm/vec3.hpp>

#include "scene/box.h"

namespace spherule::v1 {
class CylinderShape;
class SphereShape;
}  // namespace spherule::v1

namespace spherule::scene {

class Check;

// Regions of space. The surface belongs to them.

struct BallRegion {
    glm::dvec3 centre{};  // m
    double radius = 0;    // m
};

struct CylinderRegion {
    glm::dvec3 from{};  // m
    glm::dvec3 to{};    // m
    double radius = 0;  // m
};

using Region = std::variant<Box, BallRegion, CylinderRegion>;

bool contains(const Region& region, const glm::dvec3& place);
// Returns a ball that contains the region.
BallRegion ballAround(const Region& region);

// Refuse shapes that are hollow or open.
BallRegion readBall(Check& check, const v1::SphereShape& message, const std::string& field);
CylinderRegion readCylinder(Check& check, const v1::CylinderShape& message, const std::string& field);
// Refuses `given`, which is the value of `field`: hollow or open.
void refuseForm(Check& check, bool given, const std::string& field);

}  // namespace spherule::scene
