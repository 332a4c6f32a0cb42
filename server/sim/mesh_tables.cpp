#include "sim/mesh_tables.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "scene/mesh/mesh.h"
#include "scene/shapes.h"
#include "sim/layout.h"
#include "sim/mesh_grid.h"
#include "sim/mesh_tree.h"

namespace spherule::sim {

namespace layout {
#include "shared/mesh_layout.h"
}

namespace {

// A sphere looks for triangles where its centre is. It may touch one at a distance of its radius, and moves by up to
// half of it in a substep.
constexpr double reachInRadii = 1.75;

constexpr double leastCosineOfWedge = 0.2;    // wider ones have no limit: TRIANGLE_WEDGE
constexpr double mostTilt = 1e-4;             // of an edge against the plane of its patch
constexpr std::size_t mostEdgesOfWedge = 12;  // of a vertex

using Words = std::vector<std::uint32_t>;

void put(Words& words, double value) {
    words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

void put(Words& words, const glm::dvec3& v) {
    for (int axis = 0; axis < 3; ++axis) put(words, v[axis]);
}

// Returns the margin of a mesh (m): see mesh_layout.h. `reach`: the distance at which spheres look for triangles (m).
double marginOf(const scene::Mesh& mesh, double reach) {
    double bend = 0;
    for (std::uint32_t t = 0; t < mesh.corners.size(); ++t) {
        const scene::Mesh::Patch& patch = mesh.patches[mesh.patchOf[t]];
        for (unsigned k = 0; k < 3; ++k)
            bend = std::max(bend, std::abs(glm::dot(patch.normal, mesh.corner(t, k)) - patch.offset));
    }
    return 2 * bend + 8e-6 * (mesh.half.x + mesh.half.y + mesh.half.z + 3 * reach);
}

// Writes one mesh. `base`: the address of words[0]. `nextKey`: the first key that no contact has yet.
class MeshWriter {
  public:
    MeshWriter(const scene::Mesh& mesh, bool smooth, double margin, Words& words, std::uint32_t base,
               std::uint32_t& nextKey)
        : mesh_(mesh), smooth_(smooth), margin_(margin), words_(words), base_(base), nextKey_(nextKey) {}

    // Sets the addresses of the row.
    void write(const MeshTree& tree, const MeshGrid& grid, MeshTables::Row& row) {
        numberFaces();
        findOwners();
        findFans();
        putInOrder(tree);
        writeEdges();
        writeVertices();
        const std::uint32_t trianglesAt = nextLine();
        for (const std::uint32_t triangle : tree.order) writeTriangle(triangle);
        nextLine();
        words_.resize(words_.size() + LINE_WORDS - 1);
        put(words_, margin_);
        row.nodesAt = here();
        writeNodes(tree, trianglesAt);
        row.cellsAt = here();
        writeCells(grid);
    }

  private:
    [[nodiscard]] std::uint32_t here() const { return base_ + static_cast<std::uint32_t>(words_.size()); }

    // Returns the address of the next word, the first of a line.
    std::uint32_t nextLine() {
        while (here() % LINE_WORDS != 0) words_.push_back(0);
        return here();
    }

    // Springs act on a smooth part of the mesh as a whole.
    void numberFaces() {
        faceKey_.resize(mesh_.patches.size());
        for (std::uint32_t patch = 0; patch < faceKey_.size(); ++patch) {
            if (!smooth_)
                faceKey_[patch] = nextKey_++;
            else if (mesh_.smoothOf[patch] != patch)
                faceKey_[patch] = faceKey_[mesh_.smoothOf[patch]];  // a lower number
            else
                faceKey_[patch] = std::exchange(nextKey_, nextKey_ + KEYS_PER_GROUP);
        }
    }

    [[nodiscard]] std::uint32_t keyOf(std::uint32_t triangle) const { return faceKey_[mesh_.patchOf[triangle]]; }

    std::uint32_t keyBeyond(std::uint32_t triangle) { return smooth_ ? keyOf(triangle) : nextKey_++; }

    void findOwners() {
        owner_.assign(mesh_.vertices.size(), scene::Mesh::none);
        for (auto t = static_cast<std::uint32_t>(mesh_.corners.size()); t-- > 0;)
            for (const std::uint32_t corner : mesh_.corners[t]) owner_[corner] = t;
    }

    // Returns the direction out of a triangle across its edge k, in the plane of its patch.
    [[nodiscard]] glm::dvec3 awayFrom(std::uint32_t triangle, std::uint32_t edge) const {
        unsigned k = 0;
        while (mesh_.edgesOf[triangle][k] / 2 != edge) ++k;
        const glm::dvec3 along = mesh_.corner(triangle, (k + 1) % 3) - mesh_.corner(triangle, k);
        return glm::normalize(glm::cross(along, mesh_.normal(triangle)));
    }

    // Springs at the two sides of a groove act as one if they are parts of a smooth surface and differ little.
    [[nodiscard]] std::uint32_t grooveAt(const scene::Mesh::Edge& edge) const {
        const auto [first, second] = edge.triangles;
        if (!smooth_ || second == scene::Mesh::none || edge.flat) return 0;
        const bool sameWay = glm::dot(mesh_.normal(first), mesh_.normal(second)) > double{SMOOTH_COSINE};
        if (keyOf(first) == keyOf(second) && sameWay) return 0;
        if (mesh_.risesBeyond(edge)) return EDGE_GROOVE;
        return mesh_.closed() ? 0 : EDGE_GROOVE_BEHIND;
    }

    // Edges and vertices lie in memory as the leaves use them, so that what a sphere reads is together.
    void putInOrder(const MeshTree& tree) {
        placeOf_.assign(mesh_.edges.size(), scene::Mesh::none);
        std::vector<bool> seen(mesh_.vertices.size());
        for (const std::uint32_t t : tree.order) {
            for (const std::uint32_t word : mesh_.edgesOf[t]) {
                if (placeOf_[word / 2] != scene::Mesh::none) continue;
                placeOf_[word / 2] = static_cast<std::uint32_t>(edges_.size());
                edges_.push_back(word / 2);
            }
            for (const std::uint32_t corner : mesh_.corners[t]) {
                if (seen[corner]) continue;
                seen[corner] = true;
                vertices_.push_back(corner);
            }
        }
    }

    [[nodiscard]] std::uint32_t addressOf(std::uint32_t edge) const { return edgesAt_ + placeOf_[edge] * EDGE_WORDS; }

    void writeEdges() {
        edgesAt_ = nextLine();
        for (const std::uint32_t k : edges_) {
            const scene::Mesh::Edge& edge = mesh_.edges[k];
            const glm::dvec3& from = mesh_.vertices[edge.vertices[0]];
            const glm::dvec3 along = mesh_.vertices[edge.vertices[1]] - from;
            const bool shared = edge.triangles[1] != scene::Mesh::none;
            const glm::dvec3 away = awayFrom(edge.triangles[0], k);
            put(words_, from);
            put(words_, glm::normalize(along));
            put(words_, glm::length(along));
            put(words_, away);
            put(words_, !shared || edge.flat ? -away : awayFrom(edge.triangles[1], k));
            words_.push_back(edge.meets ? keyBeyond(edge.triangles[0]) : 0);
            words_.push_back((edge.meets ? EDGE_MEETS : 0U) | (shared ? EDGE_SHARED : 0U) | grooveAt(edge));
            nextLine();
        }
    }

    void findFans() {
        const std::size_t count = mesh_.vertices.size();
        fanAt_.assign(count + 1, 0);
        for (const scene::Mesh::Edge& edge : mesh_.edges)
            for (const std::uint32_t v : edge.vertices) ++fanAt_[v + 1];
        for (std::size_t v = 0; v < count; ++v) fanAt_[v + 1] += fanAt_[v];
        fans_.resize(fanAt_.back());
        std::vector<std::uint32_t> next(fanAt_.begin(), fanAt_.end() - 1);
        for (std::uint32_t k = 0; k < mesh_.edges.size(); ++k)
            for (std::uint32_t end = 0; end < 2; ++end) fans_[next[mesh_.edges[k].vertices[end]]++] = 2 * k + end;
    }

    // Returns the edges of a vertex: twice the number, plus 1 if the edge ends there.
    [[nodiscard]] std::span<const std::uint32_t> fanOf(std::uint32_t vertex) const {
        return std::span(fans_).subspan(fanAt_[vertex], fanAt_[vertex + 1] - fanAt_[vertex]);
    }

    void writeVertices() {
        vertexAt_.assign(mesh_.vertices.size(), 0);
        for (const std::uint32_t v : vertices_) {
            const auto fan = fanOf(v);
            if (std::ranges::none_of(fan, [&](std::uint32_t word) { return mesh_.edges[word / 2].meets; })) continue;
            vertexAt_[v] = here();
            put(words_, mesh_.vertices[v]);
            put(words_, mesh_.closed() ? mesh_.vertexNormals[v] : glm::dvec3(0));
            words_.push_back(keyBeyond(owner_[v]));
            words_.push_back(static_cast<std::uint32_t>(fan.size()));
            for (const std::uint32_t word : fan) words_.push_back(2 * addressOf(word / 2) + word % 2);
        }
    }

    void writeTriangle(std::uint32_t t) {
        const scene::Mesh::Patch& patch = mesh_.patches[mesh_.patchOf[t]];
        put(words_, patch.normal);
        put(words_, patch.offset);
        for (unsigned k = 0; k < 3; ++k) {
            // A needle may be folded back onto the patch that it joined. Then its third corner is outside.
            const glm::dvec3 away = awayFrom(t, mesh_.edgesOf[t][k] / 2);
            const double third = glm::dot(away, mesh_.corner(t, (k + 2) % 3) - mesh_.corner(t, k));
            const bool folded = !(third < -1e-6 * glm::length(mesh_.half));
            put(words_, folded ? glm::dvec3(0) : away);
            put(words_, folded ? 0 : glm::dot(away, mesh_.corner(t, k)));
        }
        words_.push_back(keyOf(t));
        std::uint32_t flags = mesh_.closed() ? TRIANGLE_CLOSED : 0;
        for (unsigned k = 0; k < 3; ++k)
            if (mesh_.edges[mesh_.edgesOf[t][k] / 2].vertices[0] != mesh_.corners[t][k]) flags |= TRIANGLE_TURNED << k;
        words_.push_back(flags);
        for (const std::uint32_t word : mesh_.edgesOf[t]) words_.push_back(2 * addressOf(word / 2) + word % 2);
        for (const std::uint32_t corner : mesh_.corners[t])
            words_.push_back(owner_[corner] == t ? vertexAt_[corner] : 0);
        put(words_, wedgeBeside(t));
        nextLine();
    }

    // Returns TRIANGLE_WEDGE. Places that are nearest to an edge or vertex of a solid lie in the cone of directions
    // that point away from all edges there.
    [[nodiscard]] double wedgeBeside(std::uint32_t t) const {
        if (!mesh_.closed()) return double{ANY_WEDGE};
        const glm::dvec3& normal = mesh_.normal(t);
        double cosine = 1;  // of the largest angle between the normal and such a direction
        for (const std::uint32_t word : mesh_.edgesOf[t]) {
            const scene::Mesh::Edge& edge = mesh_.edges[word / 2];
            const glm::dvec3 along =
                glm::normalize(mesh_.vertices[edge.vertices[1]] - mesh_.vertices[edge.vertices[0]]);
            if (grooveAt(edge) != 0 || std::abs(glm::dot(along, normal)) > mostTilt) return double{ANY_WEDGE};
            if (edge.meets && word % 2 == 0)
                cosine = std::min(cosine, glm::dot(normal, mesh_.normal(edge.triangles[1])));
        }
        for (const std::uint32_t corner : mesh_.corners[t])
            if (owner_[corner] == t && vertexAt_[corner] != 0) cosine = std::min(cosine, coneOf(corner, normal));
        return cosine > leastCosineOfWedge ? std::sqrt(1 - cosine * cosine) / cosine + 2 * mostTilt : double{ANY_WEDGE};
    }

    // Returns the cosine of the largest angle between a normal and a direction in the cone of a vertex. It is the angle
    // of a direction across two of the edges.
    [[nodiscard]] double coneOf(std::uint32_t vertex, const glm::dvec3& normal) const {
        const auto fan = fanOf(vertex);
        if (fan.size() > mostEdgesOfWedge) return -1;
        std::array<glm::dvec3, mostEdgesOfWedge> directions;
        for (std::size_t k = 0; k < fan.size(); ++k) {
            const auto& ends = mesh_.edges[fan[k] / 2].vertices;
            const std::uint32_t end = fan[k] % 2;
            directions[k] = glm::normalize(mesh_.vertices[ends[1 - end]] - mesh_.vertices[ends[end]]);
        }
        const auto edges = std::span(directions).first(fan.size());
        double least = 1;
        for (std::size_t i = 0; i < edges.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const glm::dvec3 across = glm::cross(edges[i], edges[j]);
                if (glm::length(across) < 1e-9) continue;  // each of the two has its directions with other edges
                for (const glm::dvec3& n : {glm::normalize(across), -glm::normalize(across)})
                    if (std::ranges::all_of(edges, [&](const glm::dvec3& edge) { return glm::dot(n, edge) < 1e-7; }))
                        least = std::min(least, glm::dot(n, normal));
            }
        return least;
    }

    void writeNodes(const MeshTree& tree, std::uint32_t trianglesAt) {
        const std::uint32_t nodesAt = here();
        for (std::uint32_t number = 0; number < tree.nodes.size(); ++number) {
            const MeshTree::Node& node = tree.nodes[number];
            const auto triangles = std::span(tree.order).subspan(node.first, node.count);
            const bool isGroup = node.leaves > 0;
            const MeshSlab slab(mesh_, triangles, node.centre(), margin_);
            const std::size_t begin = words_.size();
            put(words_, slab.axes[2]);
            put(words_, slab.low);
            put(words_, slab.high);
            put(words_, slab.centre);
            put(words_, slab.axes[0]);
            put(words_, slab.steps);
            words_.push_back(isGroup ? nodesAt + (number + 1) * NODE_WORDS : trianglesAt + node.first * TRIANGLE_WORDS);
            words_.push_back(isGroup ? node.leaves : node.count);
            words_.push_back(isGroup ? 1 : 0);
            words_.resize(begin + NODE_WORDS);
            const auto child = [&](std::uint32_t k) {
                if (!isGroup) return triangles.subspan(k, 1);
                const MeshTree::Node& leaf = tree.nodes[number + 1 + k];
                return std::span(tree.order).subspan(leaf.first, leaf.count);
            };
            for (std::uint32_t k = 0; k < (isGroup ? node.leaves : node.count); ++k) {
                const glm::uvec4 box = slab.boxOf(child(k)) | glm::uvec4(0, 0x80, 0, 0x80);  // TOP_BITS
                for (int side = 0; side < 4; ++side)
                    words_[begin + NODE_BOXES + k / 4 * 4 + static_cast<unsigned>(side)] |= box[side] << (8 * (k % 4));
            }
        }
    }

    void writeCells(const MeshGrid& grid) {
        const std::size_t cells = words_.size();
        words_.resize(cells + grid.count());
        for (std::size_t cell = 0; cell < grid.count(); ++cell) {
            if (grid.steps[cell] != 0) {
                words_[cells + cell] = EMPTY_CELL | std::bit_cast<std::uint32_t>(static_cast<float>(grid.roomOf(cell)));
                continue;
            }
            words_[cells + cell] = here();
            for (std::size_t list = 2 * cell; list < 2 * cell + 2; ++list) {
                words_.insert(words_.end(), grid.nodes.begin() + grid.first[list],
                              grid.nodes.begin() + grid.first[list + 1]);
                words_.push_back(END_OF_LIST);
            }
        }
    }

    const scene::Mesh& mesh_;
    bool smooth_;
    double margin_;
    Words& words_;
    std::uint32_t base_;
    std::uint32_t& nextKey_;
    std::uint32_t edgesAt_ = 0;
    std::vector<std::uint32_t> edges_;     // in the order of their addresses
    std::vector<std::uint32_t> placeOf_;   // of edges, in edges_
    std::vector<std::uint32_t> vertices_;  // in the order of their addresses
    std::vector<std::uint32_t> faceKey_;   // of patches
    std::vector<std::uint32_t> owner_;     // of vertices: their lowest triangle
    std::vector<std::uint32_t> vertexAt_;  // address; 0: spheres cannot touch it
    std::vector<std::uint32_t> fans_;      // edges of all vertices: see fanOf()
    std::vector<std::uint32_t> fanAt_;     // by vertex: where its edges begin in fans_
};

std::shared_ptr<const MeshTables> made(const scene::Scene& scene, double largestRadius) {
    auto tables = std::make_shared<MeshTables>();
    const auto base = static_cast<std::uint32_t>(ALL_OBSTACLES + scene.obstacles.size() + 1);
    std::uint32_t nextKey = scene::surfacesOf(scene);
    const bool smooth = scene.quality.model == scene::Model::Accurate;
    for (const scene::Obstacle& obstacle : scene.obstacles) {
        MeshTables::Row row;
        const auto mesh = obstacle.shape->mesh();
        row.firstKey = nextKey;
        if (mesh) {
            // A scene may have no spheres yet.
            const double reach = std::max(reachInRadii * largestRadius, 1e-4 * glm::length(mesh->half));
            const MeshTree tree = MeshTree::of(*mesh, reach);
            const double margin = marginOf(*mesh, reach);
            const MeshGrid grid = MeshGrid::around(*mesh, tree, reach + margin, double{NEAR_SHARE} * reach + margin);
            row.a = glm::vec4(glm::dvec4(grid.low, 1 / grid.width));
            row.b = glm::vec4(glm::dvec4(grid.cells, grid.reach));
            MeshWriter(*mesh, smooth, margin, tables->words, base, nextKey).write(tree, grid, row);
        }
        row.endKey = nextKey;
        tables->rows.push_back(row);
        tables->meshes.push_back(mesh);
    }
    return tables;
}

}  // namespace

std::shared_ptr<const MeshTables> meshTablesFor(const scene::Scene& scene, double largestRadius) {
    static std::mutex mutex;
    static std::weak_ptr<const MeshTables> last;
    static double lastRadius = 0;
    static scene::Model lastModel{};
    const std::lock_guard lock(mutex);
    auto tables = last.lock();
    const auto isSame = [](const scene::Obstacle& obstacle, const auto& mesh) {
        return obstacle.shape->mesh() == mesh;
    };
    if (tables && lastRadius == largestRadius && lastModel == scene.quality.model &&
        tables->rows.front().firstKey == scene::surfacesOf(scene) &&
        std::ranges::equal(scene.obstacles, tables->meshes, isSame))
        return tables;
    tables = made(scene, largestRadius);
    last = tables;
    lastRadius = largestRadius;
    lastModel = scene.quality.model;
    return tables;
}

}  // namespace spherule::sim
