#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace spherule::sim {

// A class of spheres of similar size.
struct SizeClass {
    double smallest = 0;  // m
    double largest = 0;
    std::uint32_t spheres = 0;

    bool operator==(const SizeClass&) const = default;
};

// The gap up to which pairs are listed, in radii, by which size classes are chosen.
constexpr double typicalMarginInRadii = 0.3;

struct RadiusStats {
    double smallest = 0;  // m
    double largest = 0;
    double mean = 0;
    // The radius that represents all spheres in the number of listed pairs: the power mean with exponent -3. A sphere
    // of radius r has about (1 + g / 2r)^3 neighbours within a gap g, so small spheres count most.
    double listing = 0;
    std::vector<SizeClass> classes;  // from the smallest to the largest; each has its own cells

    bool operator==(const RadiusStats&) const = default;
};

RadiusStats radiusStatsOf(const scene::Scene& scene);

}  // namespace spherule::sim
