#include "sim/grid.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

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

constexpr double fewestPerAxis = 8;  // two blocks of 4

// Returns the cells that cover the extent; along a periodic axis, the cells that fit in it.
std::uint32_t cellsAlong(double extent, double cellSize, bool periodic) {
    const double blocks = extent / cellSize / fewestPerAxis;
    const double needed = (periodic ? std::floor(blocks) : std::ceil(blocks)) * fewestPerAxis;
    return static_cast<std::uint32_t>(std::clamp(needed, fewestPerAxis, static_cast<double>(mostPerAxis)));
}

Level levelFor(const scene::Bounds& bounds, double largestRadius, double margin, std::uint64_t budget) {
    const glm::dvec3 extent = bounds.max - bounds.min;
    Level level;
    const double cellSize = 2 * largestRadius + margin;
    level.cellSize = static_cast<float>(cellSize);
    level.largest = static_cast<float>(largestRadius);
    for (int axis = 0; axis < 3; ++axis)
        level.cells[axis] = cellsAlong(extent[axis], cellSize, bounds.periodic[static_cast<std::size_t>(axis)]);

    auto all = [&level] { return std::uint64_t{level.cells.x} * level.cells.y * level.cells.z; };
    while (all() > budget) {
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (level.cells[axis] > level.cells[longest]) longest = axis;
        level.cells[longest] = level.cells[longest] / 16 * 8;
    }
    for (int axis = 0; axis < 3; ++axis)
        level.widths[axis] =
            bounds.periodic[static_cast<std::size_t>(axis)] ? extent[axis] / level.cells[axis] : cellSize;
    return level;
}

// Returns the number of the class's smallest spheres that fit in one cell at the densest packing.
double fullCell(const SizeClass& one, double cellSize) {
    constexpr double densest = 0.74;
    constexpr double ball = 4.18879;
    return densest * std::pow(cellSize / one.smallest, 3) / ball;
}

float sampleThresholdOf(const SizeClass& one, const Level& level) {
    const double threshold = std::ceil(thresholdInFull * fullCell(one, static_cast<double>(level.cellSize)));
    return static_cast<float>(std::clamp(threshold, smallestThreshold, 1e6));
}

}  // namespace

std::uint32_t Level::bundlesOfColour() const {
    const std::uint32_t blocks = all() / 64 / 8;
    return (blocks + BLOCKS_PER_BUNDLE - 1) / BLOCKS_PER_BUNDLE;
}

Grid gridFor(const scene::Bounds& bounds, const RadiusStats& radii, double marginInRadii) {
    Grid grid;
    const double margin = marginInRadii * (radii.classes.size() > 1 ? radii.listing : radii.mean);
    grid.margin = static_cast<float>(margin);
    grid.levels.clear();
    for (const SizeClass& one : radii.classes) {
        const std::uint64_t budget = std::max(fewestCells / radii.classes.size(), cellsPerSphere * one.spheres);
        Level level = levelFor(bounds, one.largest, margin, budget);
        level.spheres = one.spheres;
        if (!grid.levels.empty()) {
            level.first = grid.all();
            level.firstBundle = grid.bundles();
        }
        level.sampleThreshold = sampleThresholdOf(one, level);
        grid.levels.push_back(level);
    }
    return grid;
}

void addMoverLevel(Grid& grid, const scene::Bounds& bounds, const RadiusStats& radii, std::uint32_t mostMovers) {
    const Level& coarsest = grid.coarsest();
    // The farthest that a mover may move before its lists are rebuilt, in addition to the share of the margin, in
    // radii. The lists have pairs with gaps that are larger by this for each mover of a pair
    // (shaders/shared/mover_reach.h).
    constexpr double mostMoreMotion = 1;
    const auto largest = static_cast<double>(coarsest.largest);
    Level level = levelFor(bounds, largest, static_cast<double>(grid.margin) + 2 * mostMoreMotion * largest,
                           std::max(fewestCells, cellsPerSphere * mostMovers));
    level.sampleThreshold = sampleThresholdOf(radii.classes.back(), level);
    level.first = grid.all();
    level.firstBundle = grid.bundles();
    grid.levels.push_back(level);
    grid.hasMovers = true;
}

Result<void> checkPeriods(const scene::Bounds& bounds, const Grid& grid) {
    constexpr const char* names[] = {"X", "Y", "Z"};
    const Level& level = grid.coarsest();
    const double margin = static_cast<double>(grid.margin);
    const double largest = static_cast<double>(level.largest);
    const double needed = fewestPerAxis * (2 * largest + margin);
    for (int axis = 0; axis < 3; ++axis) {
        const double length = bounds.periods()[axis];
        // Rounding of the radius to float32 must not refuse a length of just so many cells.
        if (length == 0 || level.widths[axis] >= (2 * largest + margin) * (1 - 1e-6)) continue;
        return fail(ErrorKind::Input, "bounds.periodic",
                    fmt::format("has the axis {} of {:.6g} m, but needs {:.6g} m: {:.0f} cells of {:.6g} m + {:.6g} m "
                                "(largest sphere, listed gap); use longer bounds or smaller spheres",
                                names[axis], length, needed, fewestPerAxis, 2 * largest, margin));
    }
    return {};
}

}  // namespace spherule::sim
