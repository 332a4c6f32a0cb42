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

// The cells that a triangle comes near to.
class NearCells {
  public:
    NearCells(const scene::Mesh& mesh, const MeshGrid& grid) : mesh_(mesh), grid_(grid) {}

    template <class Visit>
    void visit(std::uint32_t t, Visit visit) const {
        const glm::dvec3& a = mesh_.corner(t, 0);
        const glm::dvec3& b = mesh_.corner(t, 1);
        const glm::dvec3& c = mesh_.corner(t, 2);
        const glm::uvec3 from = cellAt(glm::min(a, glm::min(b, c)) - grid_.reach);
        const glm::uvec3 to = cellAt(glm::max(a, glm::max(b, c)) + grid_.reach);
        const double reach = grid_.reach + 0.5 * std::sqrt(3.0) * grid_.width;
        const glm::dvec3 normal = glm::abs(mesh_.normal(t));
        const double slab = 1.001 * (grid_.reach + 0.5 * grid_.width * (normal.x + normal.y + normal.z)) + flatness();
        for (unsigned z = from.z; z <= to.z; ++z)
            for (unsigned y = from.y; y <= to.y; ++y)
                for (unsigned x = from.x; x <= to.x; ++x) {
                    const glm::dvec3 centre = grid_.low + grid_.width * (glm::dvec3(x, y, z) + 0.5);
                    if (std::abs(glm::dot(mesh_.normal(t), centre - a)) > slab) continue;
                    if (glm::distance(centre, scene::nearestOn(a, b, c, centre)) > 1.001 * reach) continue;
                    visit(x + std::size_t{grid_.cells.x} * (y + std::size_t{grid_.cells.y} * z));
                }
    }

  private:
    // The corners of a triangle lie near the plane of its patch.
    [[nodiscard]] double flatness() const { return 1e-5 * std::max({mesh_.half.x, mesh_.half.y, mesh_.half.z}); }

    [[nodiscard]] glm::uvec3 cellAt(const glm::dvec3& place) const {
        const glm::dvec3 cell = glm::floor((place - grid_.low) / grid_.width);
        return glm::uvec3(glm::clamp(cell, glm::dvec3(0), glm::dvec3(grid_.cells) - 1.0));
    }

    const scene::Mesh& mesh_;
    const MeshGrid& grid_;
};

// Fills the lists of the cells. Returns false if there are more than `most` entries.
bool fill(const scene::Mesh& mesh, MeshGrid& grid, std::size_t most) {
    const NearCells near(mesh, grid);
    const auto triangles = static_cast<std::uint32_t>(mesh.corners.size());
    std::vector<std::uint32_t> cellOf;
    std::vector<std::uint32_t> end(triangles);
    const std::size_t cells = std::size_t{grid.cells.x} * grid.cells.y * grid.cells.z;
    grid.first.assign(cells + 1, 0);
    for (std::uint32_t t = 0; t < triangles; ++t) {
        near.visit(t, [&](std::size_t cell) {
            cellOf.push_back(static_cast<std::uint32_t>(cell));
            ++grid.first[cell + 1];
        });
        if (cellOf.size() > most) return false;
        end[t] = static_cast<std::uint32_t>(cellOf.size());
    }
    for (std::size_t cell = 0; cell < cells; ++cell) grid.first[cell + 1] += grid.first[cell];
    std::vector<std::uint32_t> next(grid.first.begin(), grid.first.end() - 1);
    grid.triangles.resize(cellOf.size());
    for (std::uint32_t t = 0, entry = 0; t < triangles; ++t)
        for (; entry < end[t]; ++entry) grid.triangles[next[cellOf[entry]]++] = t;
    return true;
}

// Two sweeps over all cells find the steps exactly, because a diagonal step counts as one.
void findSteps(MeshGrid& grid) {
    constexpr std::uint16_t most = std::numeric_limits<std::uint16_t>::max() - 1;
    const glm::ivec3 size(grid.cells);
    grid.steps.resize(grid.first.size() - 1);
    for (std::size_t cell = 0; cell < grid.steps.size(); ++cell)
        grid.steps[cell] = grid.first[cell] == grid.first[cell + 1] ? most : 0;
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

MeshGrid MeshGrid::around(const scene::Mesh& mesh, double reach) {
    // A scene may have no spheres yet.
    reach = std::max(reach, 1e-4 * glm::length(mesh.half));
    MeshGrid grid;
    grid.reach = reach;
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
        if (fill(mesh, grid, one ? std::numeric_limits<std::size_t>::max() : entries)) break;
    }
    findSteps(grid);
    return grid;
}

}  // namespace spherule::sim
