#pragma once

#include <cstdint>

#include "frames.h"
#include "scene/scene.h"
#include "sim/simulation.h"

// Spheres of 5 cm that fall into an open box and come to rest in it, at 480 substeps per second, with sleep off.
namespace spherule::physics {

constexpr double bedRadius = 0.05;  // m

struct BedOf {
    std::uint32_t count = 1000;
    double depth = 20;  // of the bed, in layers
    double friction = 0.3;
    std::uint64_t seed = 1;
    double pitch = 2.5;  // of the lattice at the beginning, in radii
};
scene::Scene bed(const BedOf& size);

// A tray with a rim, high above the floor of a wide box. A column of 648 spheres stands on the tray. Their radii differ
// by a tenth, so that they form no crystal. Spheres that leave the tray fall to the floor and stay there.
scene::Scene heapOnTray(double friction, std::uint64_t seed);
// The spheres that are on the tray.
struct Heap {
    int spheres = 0;
    double speedRms = 0;  // m/s
};
Heap heapOf(const sim::State& state);

// A bed of 1,200 spheres, and above it a sphere of ten times their radius, with the last id.
scene::Scene bedUnderLargeSphere(std::uint64_t seed);
// Returns the height (m) of the large sphere's centre above the floor.
double largeSphereHeight(sim::Simulation& simulation);

// Returns the scene in the model `accurate`. `overlap`: of the fastest impact, in radii.
scene::Scene asAccurate(scene::Scene scene, double overlap);

// Means over 0.2 s. Lengths are as in the scene before inFrame(). Overlaps are shares of the radius.
struct Rest {
    double overlap = 0;      // mean over overlapping pairs
    double wallOverlap = 0;  // largest
    double speedRms = 0;     // m/s
    double speedMax = 0;     // m/s, largest
    double height = 0;       // of the centre of mass above the floor, m
};
Rest restOf(sim::Simulation& simulation, const scene::Scene& before, const Frame& frame = atRest());

// Runs for seconds of the scene before inFrame().
void runIn(const Frame& frame, sim::Simulation& simulation, double seconds);

}  // namespace spherule::physics
