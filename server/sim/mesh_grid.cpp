#include "sim/mesh_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/mesh/triangle_tree.h"

namespace spherule::sim {

namespace {

constexpr std::size_t fewCells = 65'536;
constexpr std::size_t mostCells = 4'000'000;  // float32 counts them exactly
constexpr std::size_t cellsPerTriangle = 4;
constexpr std::size_t entriesPerTriangle = 24;
constexpr double wider = 1.4;  // if a grid has too many cells or entries

glm::uvec3 cellsFor(const glm::dvec3& size, double width) {
    return glm::uvec3(glm::max(glm::ceil(size / width), glm::dvec3(1)));
}

// The cells that nodes come near to. A node counts as its box, a single triangle as itself.
class NearCells {
  public:
    NearCells(const scene::Mesh& mesh, const MeshTree& tree, const MeshGrid& grid)
        : mesh_(mesh), tree_(tree), grid_(grid) {}

    // Calls `visit` with each list of cells that has the node.
    template <class Visit>
    void visit(const MeshTree::Node& node, const Visit& visit) const {
        visitRange(node, cellAt(node.low - grid_.reach), cellAt(node.high + grid_.reach), visit);
    }

  private:
    // The same for the cells from `from` to `to`. Halves the range along its longest side.
    template <class Visit>
    void visitRange(const MeshTree::Node& node, const glm::uvec3& from, const glm::uvec3& to,
                    const Visit& visit) const {
        const glm::dvec3 half = 0.5 * grid_.width * (glm::dvec3(to - from) + 1.0);
        const glm::dvec3 centre = grid_.low + grid_.width * glm::dvec3(from) + half;
        if (!isNear(node, grid_.reach, centre, half)) return;
        if (from == to) {
            const auto cell = from.x + std::size_t{grid_.cells.x} * (from.y + std::size_t{grid_.cells.y} * from.z);
            return visit(2 * cell + (isNear(node, grid_.nearReach, centre, half) ? 0 : 1));
        }
        const int axis = half.x >= half.y && half.x >= half.z ? 0 : half.y >= half.z ? 1 : 2;
        glm::uvec3 middle = to;
        middle[axis] = from[axis] + (to[axis] - from[axis]) / 2;
        visitRange(node, from, middle, visit);
        glm::uvec3 next = from;
        next[axis] = middle[axis] + 1;
        visitRange(node, next, to, visit);
    }

    // Returns true if a point of the box may be within `reach` of the node (m).
    [[nodiscard]] bool isNear(const MeshTree::Node& node, double reach, const glm::dvec3& centre,
                              const glm::dvec3& half) const {
        if (node.count > 1) {
            const glm::dvec3 gap = glm::max(glm::abs(centre - node.centre()) - node.half() - half, glm::dvec3(0));
            return glm::length(gap) <= 1.001 * reach;
        }
        const std::uint32_t t = tree_.order[node.first];
        const glm::dvec3 normal = glm::abs(mesh_.normal(t));
        const double slab = 1.001 * (reach + glm::dot(normal, half));
        if (std::abs(glm::dot(mesh_.normal(t), centre - mesh_.corner(t, 0))) > slab) return false;
        const glm::dvec3 nearest = scene::nearestOn(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2), centre);
        return glm::distance(centre, nearest) <= 1.001 * (reach + glm::length(half));
    }

    [[nodiscard]] glm::uvec3 cellAt(const glm::dvec3& place) const {
        const glm::dvec3 cell = glm::floor((place - grid_.low) / grid_.width);
        return glm::uvec3(glm::clamp(cell, glm::dvec3(0), glm::dvec3(grid_.cells) - 1.0));
    }

    const scene::Mesh& mesh_;
    const MeshTree& tree_;
    const MeshGrid& grid_;
};

// Fills the lists of the cells. Returns false if there are more than `most` entries.
bool fill(const scene::Mesh& mesh, const MeshTree& tree, MeshGrid& grid, std::size_t most) {
    const NearCells near(mesh, tree, grid);
    const auto count = static_cast<std::uint32_t>(tree.tops.size());
    std::vector<std::uint32_t> listOf;
    std::vector<std::uint32_t> end(count);
    const std::size_t lists = std::size_t{2} * grid.cells.x * grid.cells.y * grid.cells.z;
    grid.first.assign(lists + 1, 0);
    for (std::uint32_t k = 0; k < count; ++k) {
        near.visit(tree.nodes[tree.tops[k]], [&](std::size_t list) {
            listOf.push_back(static_cast<std::uint32_t>(list));
            ++grid.first[list + 1];
        });
        if (listOf.size() > most) return false;
        end[k] = static_cast<std::uint32_t>(listOf.size());
    }
    for (std::size_t list = 0; list < lists; ++list) grid.first[list + 1] += grid.first[list];
    std::vector<std::uint32_t> next(grid.first.begin(), grid.first.end() - 1);
    grid.nodes.resize(listOf.size());
    for (std::uint32_t k = 0, entry = 0; k < count; ++k)
        for (; entry < end[k]; ++entry) grid.nodes[next[listOf[entry]]++] = tree.tops[k];
    return true;
}

// Two sweeps over all cells find the steps exactly, because a diagonal step counts as one.
void findSteps(MeshGrid& grid) {
    constexpr std::uint16_t most = std::numeric_limits<std::uint16_t>::max() - 1;
    const glm::ivec3 size(grid.cells);
    grid.steps.resize((grid.first.size() - 1) / 2);
    for (std::size_t cell = 0; cell < grid.steps.size(); ++cell)
        grid.steps[cell] = grid.first[2 * cell] == grid.first[2 * cell + 2] ? most : 0;
    const auto at = [&](int x, int y, int z) -> std::uint16_t& {
        return grid
            .steps[static_cast<std::size_t>(x) +
                   static_cast<std::size_t>(size.x) *
                       (static_cast<std::size_t>(y) + static_cast<std::size_t>(size.y) * static_cast<std::size_t>(z))];
    };
    const auto visit = [&](int x, int y, int z, int way) {
        std::uint16_t& here = at(x, y, z);
        if (here == 0) return;
        for (int k = 0; k < 13; ++k) {  // the neighbours that were visited before
            const int dx = way * (k % 3 - 1);
            const int dy = way * (k / 3 % 3 - 1);
            const int dz = way * (k / 9 - 1);
            if (x + dx < 0 || y + dy < 0 || z + dz < 0 || x + dx >= size.x || y + dy >= size.y || z + dz >= size.z)
                continue;
            here = std::min<std::uint16_t>(
                here, static_cast<std::uint16_t>(std::min<int>(most, at(x + dx, y + dy, z + dz) + 1)));
        }
    };
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) visit(x, y, z, 1);
    for (int z = size.z - 1; z >= 0; --z)
        for (int y = size.y - 1; y >= 0; --y)
            for (int x = size.x - 1; x >= 0; --x) visit(x, y, z, -1);
}

}  // namespace

MeshGrid MeshGrid::around(const scene::Mesh& mesh, const MeshTree& tree, double reach, double nearReach) {
    MeshGrid grid;
    grid.reach = reach;
    grid.nearReach = nearReach;
    grid.low = -mesh.half - reach;
    const glm::dvec3 size = 2.0 * (mesh.half + reach);
    const std::size_t triangles = mesh.corners.size();
    const std::size_t cells = std::min(mostCells, fewCells + cellsPerTriangle * triangles);
    const std::size_t entries = fewCells + entriesPerTriangle * triangles;
    grid.width = 0.5 * reach;
    for (;; grid.width *= wider) {
        const glm::dvec3 counts = glm::ceil(size / grid.width);
        if (counts.x * counts.y * counts.z > static_cast<double>(cells)) continue;
        grid.cells = cellsFor(size, grid.width);
        const bool one = grid.cells == glm::uvec3(1);
        if (fill(mesh, tree, grid, one ? std::numeric_limits<std::size_t>::max() : entries)) break;
    }
    findSteps(grid);
    return grid;
}

}  // namespace spherule::sim
