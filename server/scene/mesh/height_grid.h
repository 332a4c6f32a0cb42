#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh/triangles.h"

namespace spherule::scene {

// Heights on a grid, along x first.
struct HeightGrid {
    std::uint32_t columns = 0;
    std::vector<double> heights{};  // m

    [[nodiscard]] std::size_t rows() const { return columns == 0 ? 0 : heights.size() / columns; }
};

// The largest number of heights: their triangles and the sides of the solid are at most mostTriangles.
constexpr std::size_t mostHeights = 1'900'000;

// Reads CSV or PNG. A PNG's black is at `low`, its white at `high` (m), and its first row has the largest y. A CSV has
// heights (m), and its first line has the smallest y.
HeightGrid readHeights(Check& check, const MeshBytes& from, double low, double high);

// Returns the closed surface of the ground: two triangles for each cell, the sides, and the bottom. `box`: the corners
// of the grid along x and y.
Triangles groundOf(const HeightGrid& grid, const Box& box, double bottom);

}  // namespace spherule::scene
