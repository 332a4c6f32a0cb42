#include "scene/mesh/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/mesh/mesh.h"

namespace spherule::scene {

namespace {

constexpr std::uint32_t leafTriangles = 4;

enum class Feature : std::uint8_t { Face, Edge, Vertex };

// The point of a triangle nearest to another point, and the part of the triangle in which it lies.
struct Place {
    glm::dvec3 point{};
    Feature feature = Feature::Face;
    unsigned number = 0;  // of the edge or corner
};

// Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
Place placeOn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const double d1 = glm::dot(ab, p - a);
    const double d2 = glm::dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0) return {a, Feature::Vertex, 0};
    const double d3 = glm::dot(ab, p - b);
    const double d4 = glm::dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3) return {b, Feature::Vertex, 1};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, Feature::Edge, 0};
    const double d5 = glm::dot(ab, p - c);
    const double d6 = glm::dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6) return {c, Feature::Vertex, 2};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, Feature::Edge, 2};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), Feature::Edge, 1};
    const double sum = va + vb + vc;
    return {a + vb / sum * ab + vc / sum * ac, Feature::Face, 0};
}

double squaredDistance(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& point) {
    const glm::dvec3 d = point - glm::clamp(point, low, high);
    return glm::dot(d, d);
}

}  // namespace

glm::dvec3 nearestOn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& point) {
    return placeOn(a, b, c, point).point;
}

struct TriangleTree::Nearest {
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;
    Place place{};
};

TriangleTree::TriangleTree(const Mesh& mesh) : mesh_(mesh), order_(mesh.corners.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.reserve(order_.size() / 2 + 1);
    build(0, static_cast<std::uint32_t>(order_.size()));
}

void TriangleTree::build(std::uint32_t first, std::uint32_t end) {
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    const glm::dvec3 beyond(std::numeric_limits<double>::infinity());
    Node node{beyond, -beyond};
    for (std::uint32_t k = first; k < end; ++k)
        for (unsigned corner = 0; corner < 3; ++corner) {
            node.low = glm::min(node.low, mesh_.corner(order_[k], corner));
            node.high = glm::max(node.high, mesh_.corner(order_[k], corner));
        }
    if (end - first <= leafTriangles) {
        node.first = first;
        node.count = end - first;
        nodes_.push_back(node);
        return;
    }
    const glm::dvec3 side = node.high - node.low;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : (side.y >= side.z ? 1 : 2);
    const auto centre = [&](std::uint32_t t) {
        return mesh_.corner(t, 0)[axis] + mesh_.corner(t, 1)[axis] + mesh_.corner(t, 2)[axis];
    };
    const std::uint32_t middle = first + (end - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) { return centre(a) < centre(b); });
    nodes_.push_back(node);
    build(first, middle);
    nodes_[number].first = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
}

void TriangleTree::look(std::uint32_t number, const glm::dvec3& point, Nearest& nearest) const {
    const Node& node = nodes_[number];
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
        const std::uint32_t t = order_[k];
        const Place place = placeOn(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2), point);
        const glm::dvec3 d = point - place.point;
        const double squared = glm::dot(d, d);
        if (squared < nearest.squared) nearest = {squared, t, place};
    }
    if (node.count > 0) return;
    std::uint32_t near = number + 1;
    std::uint32_t far = node.first;
    double toNear = squaredDistance(nodes_[near].low, nodes_[near].high, point);
    double toFar = squaredDistance(nodes_[far].low, nodes_[far].high, point);
    if (toFar < toNear) {
        std::swap(near, far);
        std::swap(toNear, toFar);
    }
    if (toNear < nearest.squared) look(near, point, nearest);
    if (toFar < nearest.squared) look(far, point, nearest);
}

double TriangleTree::distance(const glm::dvec3& point) const {
    Nearest nearest;
    look(0, point, nearest);
    const double distance = std::sqrt(nearest.squared);
    if (!mesh_.closed()) return distance;
    const glm::dvec3 out = point - nearest.place.point;
    const std::uint32_t t = nearest.triangle;
    glm::dvec3 normal = mesh_.normal(t);
    if (nearest.place.feature == Feature::Vertex) normal = mesh_.vertexNormals[mesh_.corners[t][nearest.place.number]];
    if (nearest.place.feature == Feature::Edge) {
        const Mesh::Edge& edge = mesh_.edges[mesh_.edgesOf[t][nearest.place.number] / 2];
        for (const std::uint32_t other : edge.triangles)
            if (other != t && other != Mesh::none) normal += mesh_.normal(other);
    }
    return glm::dot(out, normal) < 0 ? -distance : distance;
}

}  // namespace spherule::scene
