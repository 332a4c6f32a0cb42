#pragma once

#include <array>
#include <cstddef>

// Results of `accurate` for the scenes of beds.h. An array has the figures of the seeds 1, 2, 3 and so on. This command
// computes them again: contact_long_tests --gtest_filter='*Accurate*'.
namespace spherule::physics {

template <class Figures>
constexpr double meanOf(const Figures& figures) {
    double sum = 0;
    for (const double figure : figures) sum += figure;
    return sum / static_cast<double>(figures.size());
}

// The overlaps of asAccurate() for these figures. The spheres of a heap hardly overlap at rest.
constexpr double bedOverlap = 0.1;  // the default of scenes
constexpr double heapOverlap = 0.2;

using BedFigures = std::array<double, 3>;
// Heights after 4 s (m): the mean of 1,000 spheres with friction 0.3, and the large sphere.
constexpr BedFigures accurateBedHeights{0.9585, 0.9661, 0.9682};
constexpr BedFigures accurateLargeHeights{0.8622, 0.8715, 0.8697};

// Spheres that remain on the tray after 8 s.
struct HeapFigures {
    double friction = 0;
    std::array<double, 6> spheres{};
};
constexpr std::array<HeapFigures, 4> accurateHeaps{{
    {0.1, {254, 246, 259, 250, 256, 245}},
    {0.3, {275, 260, 254, 257, 273, 263}},
    {0.5, {269, 255, 258, 269, 272, 269}},
    {0.8, {269, 260, 271, 258, 258, 255}},
}};

}  // namespace spherule::physics
