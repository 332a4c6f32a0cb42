#pragma once

#include <glm/vec3.hpp>

#include "baseline.h"

namespace spherule::bench {

// Tests every sphere against every other, with one invocation per sphere.
Result<std::unique_ptr<Baseline>> bruteForce(const Setting& setting);

// A grid over the domain with `slots` places per cell, filled by one atomic counter per cell.
struct SlotsGrid {
    glm::uvec3 cells{};
    std::uint32_t slots = 0;       // per cell
    std::uint32_t localSize = 64;  // 64 or 1
};
Result<std::unique_ptr<Baseline>> slotsGrid(const Setting& setting, const SlotsGrid& grid);

// 8 x 8 x 8 cells, each with slots for all spheres, and work groups of one invocation.
SlotsGrid studentGrid(const Setting& setting);

// Cells as wide as a sphere, with 64 slots each.
SlotsGrid fineGrid(const Setting& setting, std::uint32_t localSize);

// Sorts the state along x (counting sort with 65,536 keys), then walks the order in both directions.
Result<std::unique_ptr<Baseline>> sweepAndPrune(const Setting& setting);

// The simulation's own substep.
std::unique_ptr<Method> ours(sim::Simulation& simulation);

}  // namespace spherule::bench
