#pragma once

#include <string_view>
#include <vector>

#include "sim/plan.h"

// The memory that a substep moves between the device's processors and its memory, by a model of a bed at rest.
namespace spherule::sim {

// Means over the spheres of a bed of equal spheres, settled, all awake. A colour's launch visits the spheres of its
// bundles; a sphere near the side of a block belongs to the pairs of several.
struct BedMeans {
    double listedPairs = 0;    // per sphere
    double touchingPairs = 0;  // per sphere
    double visits = 0;         // launches over pairs that read the place of a sphere
    double contacts = 0;       // launches over pairs in which a sphere touches another
    double approaches = 0;     // launches over pairs in which a sphere approaches another
};

// Returns the means of a settled bed with friction 0.3, as tests/instruments/traffic_test.cpp counts and prints them.
BedMeans bedMeansOf(scene::Model model);

// The bytes per sphere that a kernel reads and writes in a substep, each word once per launch.
struct Traffic {
    std::string_view kernel;
    Array array{};
    double read = 0;
    double written = 0;
};

// Returns the traffic of the launches of each substep, without a rebuild of the lists: one row for each kernel and
// array, in the order of the launches. It is for a bed of equal spheres of one material, away from walls and obstacles,
// without fields and sleep. Accesses of less than 5 bytes per sphere have no row. Empty without contacts or without
// gravity.
std::vector<Traffic> trafficOf(const Plan& plan, const BedMeans& means);

}  // namespace spherule::sim
