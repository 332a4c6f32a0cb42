#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "sim/pipeline.h"

namespace spherule::sim {

// The components of a symmetric tensor: xx, yy, zz, xy, xz, yz.
using Tensor = std::array<double, 6>;

// The impulse that spheres gave a surface (N s), and its moment about the centre of the bounds (N m s).
struct SurfaceLoad {
    glm::dvec3 impulse{};
    glm::dvec3 moment{};
};

// Sums over the contacts of all substeps, in scenes with contact sums.
struct ContactSums {
    double seconds = 0;                // simulated
    double collisions = 0;             // between spheres
    double dissipated = 0;             // J, by contacts with spheres, walls and obstacles
    Tensor virial{};                   // J s: sum of branch times impulse over the contacts between spheres
    std::vector<SurfaceLoad> loads{};  // by surface, see scene/shapes.h; empty without surfaces

    // Returns these sums without the sums in `before`.
    [[nodiscard]] ContactSums since(const ContactSums& before) const;
};

// The device adds up the loads of surfaces in these units, powers of two. A step stays far within 64 bits, even if all
// spheres hit one surface at thousands of metres per second.
struct LoadUnits {
    double impulse = 1;  // N s
    double moment = 1;   // N m s

    static LoadUnits of(const scene::Scene& scene);
};

// Words of the sums of a surface, with all copies.
constexpr std::size_t surfaceSumWords = std::size_t{SURFACE_SUM_COPIES} * SURFACE_SUM_WORDS;
// Returns what these words of Array::SurfaceSums say that spheres gave.
SurfaceLoad surfaceLoadIn(std::span<const std::uint32_t> words, const LoadUnits& units);

// Adds the sums of the device since the last call, and clears them there. Leaves `seconds` and the loads. Waits for the
// device.
void addContactSums(ContactSums& sum, Pipeline& pipeline);

// Adds the loads of the first `surfaces` surfaces since the last call, and clears them there. Waits for the device.
void addSurfaceLoads(ContactSums& sum, std::size_t surfaces, Pipeline& pipeline, const LoadUnits& units);

}  // namespace spherule::sim
