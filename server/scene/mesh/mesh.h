#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/check.h"
#include "scene/mesh/triangles.h"

namespace spherule::v1 {
class Mesh;
class Obstacle;
}  // namespace spherule::v1

namespace spherule::scene {

class Shape;
class TriangleTree;
struct ShapeInput;

// Triangles with their edges and patches, as spheres meet them. Coordinates (m) are relative to the centre of their
// box. Immutable; scenes share it.
class Mesh {
  public:
    static constexpr std::uint32_t none = 0xffffffff;

    enum class Form : std::uint8_t { Sheet, Solid, Hollow };  // of a hollow mesh, the free space is inside

    struct Edge {
        std::array<std::uint32_t, 2> vertices{};             // the lower number first
        std::array<std::uint32_t, 2> triangles{none, none};  // the second is `none` at a border
        bool flat = false;                                   // both triangles are of one patch: spheres feel no edge
        bool meets = false;                                  // spheres may touch the edge
    };
    // Triangles in one plane. A sphere has one contact with all of them, and rolls over their edges without a bump.
    struct Patch {
        glm::dvec3 normal{};  // of unit length
        double offset = 0;    // m: normal . x in the plane
    };
    // Flaws of the file, found while the mesh was read.
    struct Report {
        std::size_t triangles = 0;   // in the file
        std::size_t moved = 0;       // vertices that were joined with one nearby
        std::size_t collapsed = 0;   // dropped triangles with two equal corners
        std::size_t duplicated = 0;  // dropped triangles
        std::size_t needles = 0;     // triangles without a normal of their own; each joins the patch of a neighbour
        std::size_t borders = 0;     // edges of one triangle
        std::size_t crowded = 0;     // edges of more than two triangles

        // Says what is not as usual, as a sentence; empty if there is nothing.
        [[nodiscard]] std::string text() const;
    };

    struct Options {
        double scale = 1;  // m per unit of the file
        Form form = Form::Sheet;
        double longestSide = 0;  // of the bounds (m); 0: the size is not checked
    };
    // Refuses a mesh that cannot be an obstacle: null.
    static std::shared_ptr<const Mesh> make(Check& check, const MeshBytes& from, Triangles triangles,
                                            const Options& options);

    Mesh();
    ~Mesh();

    // Returns the largest number of parts with which contacts can be remembered.
    [[nodiscard]] std::size_t parts() const;
    // Returns the distance of a point from the mesh (m); negative in a solid.
    [[nodiscard]] double distance(const glm::dvec3& point) const;
    [[nodiscard]] bool closed() const { return form != Form::Sheet; }
    // Returns the volume inside (m^3), negative if the normals point inward. Only for closed triangles.
    [[nodiscard]] double volume() const;
    // Returns a corner of a triangle.
    [[nodiscard]] const glm::dvec3& corner(std::uint32_t triangle, unsigned k) const {
        return vertices[corners[triangle][k]];
    }
    // Returns true if the second triangle of a shared edge does not fall below the plane of the first one.
    [[nodiscard]] bool risesBeyond(const Edge& edge) const;
    [[nodiscard]] const glm::dvec3& normal(std::uint32_t triangle) const { return patches[patchOf[triangle]].normal; }

    Form form = Form::Sheet;
    glm::dvec3 centre{};  // of its box, in the coordinates of the obstacle (m)
    glm::dvec3 half{};    // half of the sides of its box (m)
    std::vector<glm::dvec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> corners;  // of triangles; counter-clockwise seen from the free side
    // Edge k of a triangle leads from corner k to the next: twice its number, plus 1 if the triangle is its second.
    std::vector<std::array<std::uint32_t, 3>> edgesOf;
    std::vector<Edge> edges;
    std::vector<std::uint32_t> patchOf;  // of triangles
    std::vector<Patch> patches;
    std::vector<std::uint32_t> smoothOf;    // of patches: those that are joined by edges of less than 10 degrees
    std::vector<glm::dvec3> vertexNormals;  // mean normals, weighted by angles
    Report report;

  private:
    mutable std::once_flag treeMade_;
    mutable std::unique_ptr<TriangleTree> tree_;
};

// An obstacle of triangles. `message` gives it in scenes: its mesh or its height field.
std::shared_ptr<const Shape> meshShape(std::shared_ptr<const Mesh> mesh, const v1::Obstacle& message);

// Reads the mesh, which is the field `here` of the scene. Returns null if it is refused.
std::shared_ptr<const Shape> readMesh(Check& check, const v1::Mesh& message, const std::string& here,
                                      const ShapeInput& input);

// The same without a message, which a scene cannot be written with. Null if the triangles are refused.
std::shared_ptr<const Shape> meshShape(Triangles triangles, Mesh::Form form);

// The steps of Mesh::make(), in their order.

// Joins equal vertices, and those within 1e-6 of the box. Drops triangles without three corners, and duplicates.
void weld(Mesh& mesh, const Triangles& triangles, double scale);
// Finds the edges, and turns the triangles of a sheet the same way.
void findEdges(Mesh& mesh);
// Refuses a mesh that does not enclose a volume, or whose normals do not point outward.
void checkClosed(Check& check, const MeshBytes& from, const Mesh& mesh, double scale);
// Finds patches, the edges that spheres can touch, and the mean normals of vertices.
void findPatches(Mesh& mesh, double largestCoordinate);

}  // namespace spherule::scene
