#pragma once

#include <cstdint>

#include "scene/scene.h"

// Gases in bounds that are periodic along all axes.
namespace spherule::physics {

struct PeriodicGasOf {
    std::uint32_t count = 256;  // 4 times a cube
    double fraction = 0.2;      // volume of the spheres per volume of the bounds, if radii are equal
    double spread = 1;          // m/s, standard deviation of the velocities along each axis
    double ratio = 1;           // of the largest radius to the smallest
};

constexpr double gasRadius = 0.05;  // m, the largest

// Spheres on a lattice of cubes with a sphere in each corner and on each face, with random velocities and a centre of
// mass at rest. The restitution is 1.
scene::Scene periodicGas(const PeriodicGasOf& gas, std::uint64_t seed);
double sideOf(const scene::Scene& scene);  // m

// Sets the model, with the substeps that it chooses. `overlap`: of the fastest impact in the model `accurate`, in
// radii.
void chooseModel(scene::Scene& scene, scene::Model model, double overlap);

// P V / (N k T) of hard spheres (Carnahan and Starling 1969).
double carnahanStarling(double fraction);

struct GasPressure {
    double compressibility = 0;  // P V / (N k T), from the virial of the impacts
    double impacts = 0;
};
// Measures until there have been `impacts` impacts.
GasPressure pressureOf(scene::Model model, double fraction, std::uint32_t count, std::uint64_t seed, double impacts);

struct GasFlux {
    double measured = 0;  // crossings of the seams, per area and time (1/(m^2 s))
    double expected = 0;  // n v / 4
    std::uint64_t crossings = 0;
};
// Measures until spheres have crossed the three seams `crossings` times, both ways together.
GasFlux fluxOf(scene::Model model, std::uint32_t count, std::uint64_t seed, std::uint64_t crossings);

}  // namespace spherule::physics
