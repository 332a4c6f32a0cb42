#include "sim/grid.h"

#include <algorithm>
#include <cmath>

namespace spherule::sim {

namespace {

// Gap up to which pairs are listed, in mean radii: a wider one lists more pairs, a narrower one rebuilds more often.
constexpr double marginInRadii = 0.3;
constexpr std::uint64_t cellsPerSphere = 2;
constexpr std::uint64_t fewestCells = 4096;
constexpr std::uint32_t mostPerAxis = 1U << 16U;

std::uint32_t cellsAlong(double extent, double cellSize) {
    const double wanted = std::ceil(extent / cellSize / 4) * 4;
    return static_cast<std::uint32_t>(std::clamp(wanted, 4.0, static_cast<double>(mostPerAxis)));
}

}  // namespace

Grid gridFor(glm::dvec3 extent, double largestRadius, double meanRadius, std::uint32_t spheres) {
    Grid grid;
    const double margin = marginInRadii * meanRadius;
    const double cellSize = 2 * largestRadius + margin;
    grid.margin = static_cast<float>(margin);
    grid.cellSize = static_cast<float>(cellSize);
    for (int axis = 0; axis < 3; ++axis) grid.cells[axis] = cellsAlong(extent[axis], cellSize);

    const std::uint64_t budget = std::max(fewestCells, cellsPerSphere * spheres);
    auto all = [&grid] { return std::uint64_t{grid.cells.x} * grid.cells.y * grid.cells.z; };
    while (all() > budget) {
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (grid.cells[axis] > grid.cells[longest]) longest = axis;
        grid.cells[longest] = grid.cells[longest] / 8 * 4;
    }
    return grid;
}

}  // namespace spherule::sim
