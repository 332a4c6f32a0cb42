#pragma once

#include <array>

#include "sim/pipeline.h"

namespace spherule::sim {

// The components of a symmetric tensor: xx, yy, zz, xy, xz, yz.
using Tensor = std::array<double, 6>;

// Sums over the contacts of all substeps, in scenes with contact sums.
struct ContactSums {
    double seconds = 0;     // simulated
    double collisions = 0;  // between spheres
    double dissipated = 0;  // J, by contacts with spheres, walls and obstacles
    Tensor virial{};        // J s: sum of branch times impulse over the contacts between spheres

    // Returns these sums without the sums in `before`.
    [[nodiscard]] ContactSums since(const ContactSums& before) const;
};

// Adds the sums of the device since the last call, and clears them there. Leaves `seconds`. Waits for the device.
void addContactSums(ContactSums& sum, Pipeline& pipeline);

}  // namespace spherule::sim
