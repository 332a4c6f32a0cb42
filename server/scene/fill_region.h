#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/packing.h"
#include "scene/region.h"
#include "scene/scene.h"
#include "scene/shapes.h"

namespace spherule::v1 {
class Fill;
}

namespace spherule::scene {

// The region of a fill: spheres are inside of it as a whole. Along a periodic axis that a box spans, only their centres
// are.
struct FillRegion {
    std::variant<Box, BallRegion, CylinderRegion, ShapePointer> form{};  // the shape is a closed mesh
    Box box{};                                                           // around it
    double volume = 0;                                                   // m^3

    // Returns a place (m) for the centre of a sphere, uniform among all such places; nullopt if the place that it draws
    // is outside of a mesh.
    [[nodiscard]] std::optional<glm::dvec3> draw(Random& random, const Bounds& bounds, double radius) const;
    // Returns the surfaces that end it.
    [[nodiscard]] std::vector<Surface> surfaces(const Bounds& bounds) const;
    // Returns the radius of the largest sphere in it (m); of a mesh, of one in its box.
    [[nodiscard]] double largestRadius() const;
};

// Reads the region. Refuses one that reaches out of the bounds.
FillRegion readFillRegion(Check& check, const v1::Fill& message, const std::string& field, const Bounds& bounds,
                          const ShapeInput& input);

}  // namespace spherule::scene
