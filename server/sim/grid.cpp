#include "sim/grid.h"

#include <algorithm>
#include <cmath>

#include "sim/layout.h"

namespace spherule::sim {

namespace {

constexpr std::uint64_t cellsPerSphere = 2;
constexpr std::uint64_t fewestCells = 4096;
constexpr std::uint32_t mostPerAxis = 1U << 16U;
// An overfull cell has many times more spheres than fit without overlap. A cell of a heap under load must never count
// as overfull.
constexpr double thresholdInFull = 4;
constexpr double smallestThreshold = 64;

std::uint32_t cellsAlong(double extent, double cellSize) {
    const double needed = std::ceil(extent / cellSize / 8) * 8;
    return static_cast<std::uint32_t>(std::clamp(needed, 8.0, static_cast<double>(mostPerAxis)));
}

Level levelFor(glm::dvec3 extent, double largestRadius, double margin, std::uint64_t budget) {
    Level level;
    const double cellSize = 2 * largestRadius + margin;
    level.cellSize = static_cast<float>(cellSize);
    level.largest = static_cast<float>(largestRadius);
    for (int axis = 0; axis < 3; ++axis) level.cells[axis] = cellsAlong(extent[axis], cellSize);

    auto all = [&level] { return std::uint64_t{level.cells.x} * level.cells.y * level.cells.z; };
    while (all() > budget) {
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (level.cells[axis] > level.cells[longest]) longest = axis;
        level.cells[longest] = level.cells[longest] / 16 * 8;
    }
    return level;
}

// Returns the number of the class's smallest spheres that fit in one cell at the densest packing.
double fullCell(const SizeClass& one, double cellSize) {
    constexpr double densest = 0.74;
    constexpr double ball = 4.18879;
    return densest * std::pow(cellSize / one.smallest, 3) / ball;
}

}  // namespace

std::uint32_t Level::bundlesOfColour() const {
    const std::uint32_t blocks = all() / 64 / 8;
    return (blocks + BLOCKS_PER_BUNDLE - 1) / BLOCKS_PER_BUNDLE;
}

Grid gridFor(glm::dvec3 extent, const RadiusStats& radii, double marginInRadii) {
    Grid grid;
    const double margin = marginInRadii * (radii.classes.size() > 1 ? radii.listing : radii.mean);
    grid.margin = static_cast<float>(margin);
    grid.levels.clear();
    for (const SizeClass& one : radii.classes) {
        const std::uint64_t budget = std::max(fewestCells / radii.classes.size(), cellsPerSphere * one.spheres);
        Level level = levelFor(extent, one.largest, margin, budget);
        level.spheres = one.spheres;
        if (!grid.levels.empty()) {
            level.first = grid.all();
            level.firstBundle = grid.bundles();
        }
        const double sampleThreshold = std::ceil(thresholdInFull * fullCell(one, static_cast<double>(level.cellSize)));
        level.sampleThreshold = static_cast<float>(std::clamp(sampleThreshold, smallestThreshold, 1e6));
        grid.levels.push_back(level);
    }
    return grid;
}

}  // namespace spherule::sim
