#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace spherule::sim {

// Spheres of like size.
struct SizeClass {
    double smallest = 0;  // m
    double largest = 0;
    std::uint32_t spheres = 0;
};

// Gap up to which pairs are listed, in radii: a wider one lists more pairs, a narrower one rebuilds more often.
constexpr double marginInRadii = 0.3;

struct Radii {
    double smallest = 0;  // m
    double largest = 0;
    double mean = 0;
    // What stands for all in the number of pairs to list: pairs within a gap g of a sphere of radius r are some
    // (1 + g / 2r)^3, so that small ones count most.
    double listing = 0;
    std::vector<SizeClass> classes;  // from the smallest to the largest; each has cells of its own
};

Radii radiiOf(const scene::Scene& scene);

}  // namespace spherule::sim
