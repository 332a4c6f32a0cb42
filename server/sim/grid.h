#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"
#include "scene/scene.h"
#include "sim/radius_stats.h"

namespace spherule::sim {

// Cells for spheres of similar size. They form a torus, so that memory is bounded wherever spheres go. They are cubes,
// except that they are wider along a periodic axis, so that a whole number of them fits its length.
struct Level {
    float cellSize = 0;       // m, the narrowest width
    glm::dvec3 widths{};      // m, per axis
    float largest = 0;        // radius, m
    glm::uvec3 cells{0};      // per axis, multiples of 8
    std::uint32_t first = 0;  // index of its first cell among the cells of all levels
    std::uint32_t firstBundle = 0;
    std::uint32_t spheres = 0;
    float sampleThreshold = 0;  // a cell with more spheres than this has spheres that overlap deeply

    [[nodiscard]] std::uint32_t all() const { return cells.x * cells.y * cells.z; }
    // Returns the number of bundles of each of the eight colours: see shaders/shared/bundles.h.
    [[nodiscard]] std::uint32_t bundlesOfColour() const;
    bool operator==(const Level&) const = default;
};

// The broad phase's cells.
struct Grid {
    float margin = 0;                                   // m; pairs are listed up to this gap
    std::vector<Level> levels = std::vector<Level>(1);  // from the finest to the coarsest; one if radii are similar
    bool hasMovers = false;                             // the last level is for movers (shaders/shared/movers.h)

    [[nodiscard]] std::uint32_t all() const { return levels.back().first + levels.back().all(); }
    [[nodiscard]] std::uint32_t bundles() const {
        return levels.back().firstBundle + 8 * levels.back().bundlesOfColour();
    }
    // Returns the levels for spheres of different size.
    [[nodiscard]] std::size_t sizes() const { return levels.size() - (hasMovers ? 1 : 0); }
    [[nodiscard]] const Level& coarsest() const { return levels[sizes() - 1]; }
    bool operator==(const Grid&) const = default;
};

// Returns cells as wide as the largest sphere plus the margin. They cover the domain, but there are at most about two
// per sphere. In larger domains distant places share cells, which costs more tests and finds the same contacts.
// `marginInRadii`: the gap up to which pairs are listed.
Grid gridFor(const scene::Bounds& bounds, const RadiusStats& radii, double marginInRadii);

// Adds the level of movers, for at most so many of them.
void addMoverLevel(Grid& grid, const scene::Bounds& bounds, const RadiusStats& radii, std::uint32_t mostMovers);

// Refuses a periodic axis that is too short for the cells of the grid: two blocks of the pair order (shared/bundles.h).
Result<void> checkPeriods(const scene::Bounds& bounds, const Grid& grid);

}  // namespace spherule::sim
