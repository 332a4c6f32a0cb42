#include "scene/tessellation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/facts.pb.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

constexpr int sides = 64;

glm::dvec3 vectorIn(const Numbers& values) {
    return {values[0], values[1], values[2]};
}

// A line that is turned around the z axis of a frame: distances from the axis, and places along it (m). The solid is on
// its left.
using Outline = std::vector<glm::dvec2>;

// Adds a part of a circle around (0, `along`), from the angle `from` to `to` (quarters of a turn).
void addArc(Outline& outline, double radius, double along, int from, int to) {
    constexpr int steps = sides / 4;
    for (int k = from * steps; k <= to * steps; ++k) {
        const double angle = std::numbers::pi / 2 * k / steps;
        outline.emplace_back(radius * std::cos(angle), along + radius * std::sin(angle));
    }
    // Exactly on the axis, where there is one point.
    if (from == -1) outline.front().x = 0;
    if (to == 1) outline.back().x = 0;
}

Outline coneOutline(double low, double high, double half, bool open) {
    if (open) return {{low, -half}, {high, half}};
    return {{0, -half}, {low, -half}, {high, half}, {0, half}};
}

// `inside`: the free space is inside.
void addTriangle(Tessellation& surface, bool inside, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    surface.corners.push_back(inside ? glm::uvec3(a, c, b) : glm::uvec3(a, b, c));
}

Tessellation turnedAround(const Outline& outline, const Frame& frame, bool inside) {
    Tessellation surface;
    struct Ring {
        std::uint32_t first;
        std::uint32_t points;  // 1: on the axis
        [[nodiscard]] std::uint32_t at(int side) const { return first + static_cast<std::uint32_t>(side) % points; }
    };
    std::vector<Ring> rings;
    for (const glm::dvec2& from : outline) {
        const Ring ring{static_cast<std::uint32_t>(surface.points.size()), from.x > 0 ? sides : 1U};
        for (std::uint32_t side = 0; side < ring.points; ++side) {
            const double angle = 2 * std::numbers::pi * side / sides;
            surface.points.push_back(frame.outside({from.x * std::cos(angle), from.x * std::sin(angle), from.y}));
        }
        rings.push_back(ring);
    }
    for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
        const Ring& low = rings[k];
        const Ring& high = rings[k + 1];
        for (int side = 0; side < sides; ++side) {
            if (low.points > 1) addTriangle(surface, inside, low.at(side), low.at(side + 1), high.at(side + 1));
            if (high.points > 1) addTriangle(surface, inside, low.at(side), high.at(side + 1), high.at(side));
        }
    }
    return surface;
}

Tessellation boxTriangles(const v1::Box& shape, const Frame& frame) {
    Tessellation surface;
    const std::array ends = {vectorIn(shape.min()), vectorIn(shape.max())};
    for (std::uint32_t corner = 0; corner < 8; ++corner)
        surface.points.push_back(frame.outside({ends[corner & 1U].x, ends[corner >> 1U & 1U].y, ends[corner >> 2U].z}));
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t u = 1U << (axis + 1) % 3;
        const std::uint32_t v = 1U << (axis + 2) % 3;
        for (const bool far : {false, true}) {
            const std::uint32_t base = far ? 1U << axis : 0;
            addTriangle(surface, shape.hollow() != far, base, base | v, base | u | v);
            addTriangle(surface, shape.hollow() != far, base, base | u | v, base | u);
        }
    }
    return surface;
}

// Returns the part of the plane in the box, as a polygon around its normal of unit length.
Tessellation planeTriangles(const glm::dvec3& point, const glm::dvec3& normal, const Box& box) {
    Tessellation surface;
    std::vector<glm::dvec3>& points = surface.points;
    const std::array ends = {box.min, box.max};
    const auto corner = [&](unsigned k) { return glm::dvec3(ends[k & 1U].x, ends[k >> 1U & 1U].y, ends[k >> 2U].z); };
    for (unsigned k = 0; k < 8; ++k) {
        for (const unsigned edge : {1U, 2U, 4U}) {
            if ((k & edge) != 0) continue;
            const glm::dvec3 a = corner(k);
            const glm::dvec3 b = corner(k | edge);
            const double above = glm::dot(a - point, normal);
            const double below = glm::dot(b - point, normal);
            if (above * below > 0 || above == below) continue;
            points.push_back(glm::mix(a, b, above / (above - below)));
        }
    }
    if (points.size() < 3) return {};
    glm::dvec3 centre{};
    for (const glm::dvec3& one : points) centre += one / static_cast<double>(points.size());
    const glm::dmat3 turn = Ends{point, point + normal}.frame().turn;
    const auto angle = [&](const glm::dvec3& one) {
        return std::atan2(glm::dot(one - centre, turn[1]), glm::dot(one - centre, turn[0]));
    };
    std::ranges::sort(points, {}, angle);
    for (std::uint32_t k = 2; k < points.size(); ++k) addTriangle(surface, false, 0, k - 1, k);
    return surface;
}

Tessellation discTriangles(const v1::DiscShape& disc, const Frame& frame) {
    const glm::dvec3 centre = vectorIn(disc.centre());
    const Ends axis{centre, centre + glm::normalize(vectorIn(disc.normal()))};
    return turnedAround({{disc.hole(), 0}, {disc.radius(), 0}}, frame * Frame{axis.frame().turn, centre}, false);
}

template <class Shape>
Frame frameOf(const Shape& shape, double& half) {
    const Ends ends{vectorIn(shape.from()), vectorIn(shape.to())};
    half = ends.half();
    return ends.frame();
}

Tessellation sphereTriangles(const v1::SphereShape& sphere, const Frame& frame) {
    Outline outline;
    addArc(outline, sphere.radius(), 0, -1, 1);
    return turnedAround(outline, frame * Frame{glm::dmat3(1), vectorIn(sphere.centre())}, sphere.hollow());
}

Tessellation capsuleTriangles(const v1::CapsuleShape& capsule, const Frame& frame) {
    double half = 0;
    const Frame own = frameOf(capsule, half);
    Outline outline;
    addArc(outline, capsule.radius(), -half, -1, 0);
    addArc(outline, capsule.radius(), half, 0, 1);
    return turnedAround(outline, frame * own, capsule.hollow());
}

template <class Shape>
Tessellation coneTriangles(const Shape& shape, double low, double high, const Frame& frame) {
    double half = 0;
    const Frame own = frameOf(shape, half);
    return turnedAround(coneOutline(low, high, half, shape.open()), frame * own, shape.hollow());
}

// Returns nothing for triangles that name vertices beyond the last one. `hollow`: of the box in place of the triangles.
Tessellation meshTriangles(const v1::MeshFacts& mesh, bool hollow, const Frame& frame) {
    if (mesh.vertices().empty() && mesh.min_size() == 3 && mesh.max_size() == 3) {
        v1::Box box;
        *box.mutable_min() = mesh.min();
        *box.mutable_max() = mesh.max();
        box.set_hollow(hollow);
        return boxTriangles(box, frame);
    }
    Tessellation surface;
    std::vector<glm::vec3> vertices(mesh.vertices().size() / sizeof(glm::vec3));
    std::memcpy(vertices.data(), mesh.vertices().data(), vertices.size() * sizeof(glm::vec3));
    for (const glm::vec3& vertex : vertices) surface.points.push_back(frame.outside(vertex));
    surface.corners.resize(mesh.indices().size() / sizeof(glm::uvec3));
    std::memcpy(surface.corners.data(), mesh.indices().data(), surface.corners.size() * sizeof(glm::uvec3));
    const auto isThere = [&](const glm::uvec3& one) { return std::max({one.x, one.y, one.z}) < vertices.size(); };
    if (!std::ranges::all_of(surface.corners, isThere)) return {};
    return surface;
}

// Returns how the obstacle lies in the scene.
Frame placeOf(Check& check, const v1::Obstacle& obstacle) {
    Frame place;
    if (obstacle.has_rotation())
        place.turn = glm::mat3_cast(readRotation(check, obstacle.rotation(), "rotation").quaternion());
    place.origin = check.vectorOr(obstacle.translation(), {}, "translation");
    return place;
}

}  // namespace

void Tessellation::append(const Tessellation& other) {
    const glm::uvec3 before(static_cast<std::uint32_t>(points.size()));
    points.insert(points.end(), other.points.begin(), other.points.end());
    for (const glm::uvec3& each : other.corners) corners.push_back(before + each);
}

Tessellation tessellationOf(const v1::Obstacle& obstacle, const v1::MeshFacts* mesh, const Frame& pose,
                            const Box& bounds) {
    Check check;
    if (mesh == nullptr) readShape(check, obstacle, "obstacle");
    const Frame frame = pose * placeOf(check, obstacle);
    if (!check.ok()) return {};
    if (mesh != nullptr) return meshTriangles(*mesh, obstacle.mesh().hollow(), frame);
    switch (obstacle.shape_case()) {
        case v1::Obstacle::kPlane: {
            const v1::Plane& plane = obstacle.plane();
            const glm::dvec3 normal = frame.turn * glm::normalize(vectorIn(plane.normal()));
            return planeTriangles(frame.outside(vectorIn(plane.point())), normal, bounds);
        }
        case v1::Obstacle::kBox:
            return boxTriangles(obstacle.box(), frame);
        case v1::Obstacle::kSphere:
            return sphereTriangles(obstacle.sphere(), frame);
        case v1::Obstacle::kCylinder:
            return coneTriangles(obstacle.cylinder(), obstacle.cylinder().radius(), obstacle.cylinder().radius(),
                                 frame);
        case v1::Obstacle::kCone:
            return coneTriangles(obstacle.cone(), obstacle.cone().from_radius(), obstacle.cone().to_radius(), frame);
        case v1::Obstacle::kCapsule:
            return capsuleTriangles(obstacle.capsule(), frame);
        case v1::Obstacle::kDisc:
            return discTriangles(obstacle.disc(), frame);
        default:
            return {};
    }
}

}  // namespace spherule::scene
