#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <google/protobuf/repeated_field.h>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/frame.h"
#include "scene/scene.h"

namespace spherule::v1 {
class Obstacle;
}

namespace spherule::scene {

class Check;
class Mesh;

// The shapes of obstacles: the rows of shaders/shapes.def. Each has a file in scene/shapes/.
enum class ShapeKind : std::uint8_t {
#define SHAPE(flag, Name, text, number, function) Name,
#include "shapes.def"
#undef SHAPE
};

// The shape of an obstacle in world coordinates (m). It bounds the solid that spheres cannot enter. Immutable, so that
// scenes share it.
class Shape {
  public:
    virtual ~Shape() = default;

    [[nodiscard]] virtual ShapeKind kind() const = 0;
    // Returns the number of surfaces that a sphere may touch at the same time.
    [[nodiscard]] virtual std::uint32_t parts() const { return 1; }
    // Returns the distance of a point from the solid (m), negative inside it.
    [[nodiscard]] virtual double distance(const glm::dvec3& point) const = 0;
    // Returns the normal of the surface if the solid is a half-space.
    [[nodiscard]] virtual std::optional<glm::dvec3> normalOfHalfSpace() const { return std::nullopt; }
    // Returns the largest distance of a point of its surface from a point, or more (m); infinity for a half-space.
    [[nodiscard]] virtual double farthest(const glm::dvec3& from) const = 0;
    // Returns the largest coordinate (m) that kernels round when they compute distances from this shape, relative to
    // `origin`; 0 if it is no larger than the coordinates of the spheres.
    [[nodiscard]] virtual double largestCoordinate(const glm::dvec3& origin) const { return farthest(origin); }

    // Returns its triangles if it has the kind Meshes, in the coordinates of its frame; null for others.
    [[nodiscard]] virtual std::shared_ptr<const Mesh> mesh() const { return nullptr; }

    // The members a and b of its row for kernels: see shaders/shapes/. Without a frame, positions are relative to
    // `origin`; with one, they are in the frame's coordinates.
    struct Row {
        glm::vec4 a{};
        glm::vec4 b{};
        std::optional<Frame> frame{};
    };
    [[nodiscard]] virtual Row row(const glm::dvec3& origin) const = 0;
    // Writes the shape in the form in which scenes give it.
    virtual void write(v1::Obstacle& message) const = 0;
    // Writes only how the shape is turned and moved.
    virtual void writePlace(v1::Obstacle& /*message*/) const {}
};

using ShapePointer = std::shared_ptr<const Shape>;

// The surroundings in which a shape is read.
struct ShapeInput {
    std::optional<std::filesystem::path> directory{};  // of files that the scene names; nullopt: it may not name any
    double longestSide = 1;                            // of the bounds (m)
    std::shared_ptr<const Mesh> mesh{};                // what would be read from its bytes; null: it has to be read
};

// Reads the shape of an obstacle, whose field in the scene is `field`. Refuses an obstacle without one.
ShapePointer readShape(Check& check, const v1::Obstacle& message, const std::string& field,
                       const ShapeInput& input = {});

// The ends of a shape along a line: two points that differ.
struct Ends {
    glm::dvec3 from{};
    glm::dvec3 to{};

    [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (from + to); }
    [[nodiscard]] double half() const;  // half of its length (m)
    // Returns the frame whose origin is the centre, and whose z axis leads from `from` to `to`.
    [[nodiscard]] Frame frame() const;
};
Ends readEnds(Check& check, const google::protobuf::RepeatedField<double>& from,
              const google::protobuf::RepeatedField<double>& to, const std::string& field);

// Returns the vector with unit length. One that has it stays as it is, so that a saved scene is the same when it is
// saved again.
glm::dvec3 unitVector(const glm::dvec3& vector);

// Refuses a hollow shape that is open: both of its sides are free.
void refuseHollow(Check& check, bool hollow, const std::string& field);

constexpr std::uint32_t partsAroundAxis = 5;  // AROUND_AXIS in shaders/shared/shapes.h

// Returns a shape of this kind with a size of about 1 m, whose solid is below the plane z = `top`.
ShapePointer exampleOf(ShapeKind kind, double top);

// Surfaces are numbered through the faces of the bounds (by Face) and the parts of the obstacles, in their order.
constexpr std::uint32_t faceCount = 6;
std::uint32_t surfacesOf(const Scene& scene);

// A half-space. `normal` is of unit length and points to the free side.
ShapePointer planeShape(const glm::dvec3& point, const glm::dvec3& normal);
ShapePointer boxShape(const Box& box, bool hollow = false);

// The side of a cone or cylinder without ends, in the form in which scenes give it.
ShapePointer openCone(const Ends& ends, double fromRadius, double toRadius);
ShapePointer openCylinder(const Ends& ends, double radius);
// A shape in a frame of its own.
ShapePointer placedShape(ShapePointer shape, const Rotation& rotation, const glm::dvec3& translation);

// Returns the shape turned and moved as a whole.
ShapePointer movedShape(const ShapePointer& shape, const Frame& by);
// Returns where the origin of the shape's coordinates is (m).
glm::dvec3 originOf(const Shape& shape);

// How one kind of shape is read and made. Defined in its file in scene/shapes/.
struct ShapeType {
    int field = 0;  // v1::Obstacle::ShapeCase
    ShapePointer (*read)(Check& check, const v1::Obstacle& message, const std::string& field,
                         const ShapeInput& input) = nullptr;
    ShapePointer (*example)(double top) = nullptr;
};
#define SHAPE(flag, Name, text, number, function) extern const ShapeType shapes##Name;
#include "shapes.def"
#undef SHAPE
extern const ShapeType shapesHeightFields;  // read as a message of its own, made as a mesh

}  // namespace spherule::scene
