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
class Random;

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
// Returns the smallest box along the axes that contains the region.
Box boxAround(const Region& region);
double volumeOf(const Region& region);  // m^3

// Return a place (m) that is uniform in the region, with the same bits everywhere.
glm::dvec3 placeIn(const Box& box, Random& random);
glm::dvec3 placeIn(const BallRegion& ball, Random& random);
glm::dvec3 placeIn(const CylinderRegion& cylinder, Random& random);
// Returns a point of the plane across `normal` that is uniform between two circles about 0 (radii in m).
glm::dvec3 placeInRing(const glm::dvec3& normal, double hole, double radius, Random& random);

// Refuse shapes that are hollow or open.
BallRegion readBall(Check& check, const v1::SphereShape& message, const std::string& field);
CylinderRegion readCylinder(Check& check, const v1::CylinderShape& message, const std::string& field);
// Refuses `given`, which is the value of `field`: hollow or open.
void refuseForm(Check& check, bool given, const std::string& field);

}  // namespace spherule::scene
