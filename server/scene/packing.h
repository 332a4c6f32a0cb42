#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/box.h"

namespace spherule::scene {

class Check;

// A surface that no sphere reaches beyond: the distance of a point from it (m), negative beyond it. The distance of two
// points from it differs by no more than they are apart.
using Surface = std::function<double(const glm::dvec3&)>;

struct PackedSphere {
    glm::dvec3 centre{};  // m
    double radius = 0;    // m
};

// The space in which spheres are packed.
struct PackingSpace {
    Box box{};                          // around the centres
    glm::dvec3 periods{};               // m: of axes along which the box is a whole period; 0 for the others
    std::vector<Surface> surfaces{};    // of the region and of obstacles
    std::vector<PackedSphere> fixed{};  // spheres that stay where they are
};

struct PackingEnd {
    bool packed = false;  // no sphere reaches into another one or beyond a surface
    double share = 0;     // below 1 otherwise: with this share of their radii none would
};

// Moves spheres from random places until they do not overlap: a quench of soft spheres as in C. O'Hern et al., "Jamming
// at zero temperature and zero applied stress", Phys. Rev. E 68, 011306 (2003), with the minimiser FIRE of E. Bitzek et
// al., "Structural relaxation made simple", Phys. Rev. Lett. 97, 170201 (2006). Ends without success if the spheres
// jam, after a limited amount of work, or if `check` was cancelled. The surfaces aside, it uses exactly rounded
// operations alone, in one order, so that the places have the same bits everywhere.
PackingEnd pack(Check& check, std::vector<PackedSphere>& spheres, const PackingSpace& space);

// Returns the share of the volume at which spheres of these radii jam, for many spheres without walls. It follows from
// mean, deviation and skewness of the radii: K. Desmond and E. Weeks, "Influence of particle size distribution on
// random close packing of spheres", Phys. Rev. E 90, 022204 (2014).
double closestPacking(const std::vector<PackedSphere>& spheres);

// The largest number of spheres that pack() is meant for: its work is limited.
constexpr std::size_t mostPacked = 2'000'000;

// Returns the memory (bytes) that pack() needs for each sphere, fixed ones included, besides the spheres themselves.
std::size_t packingBytesPerSphere();

}  // namespace spherule::scene
