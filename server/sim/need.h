#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "compute/device.h"
#include "core/memory.h"
#include "sim/plan.h"

// The memory that simulations take: all that grows with the number of spheres, counted before any of it is taken.
namespace spherule::sim {

struct Need {
    struct Part {
        std::string_view name;
        std::uint64_t bytes = 0;
    };
    std::uint64_t arrays = 0;  // of the plan, on the device; where that has no memory of its own, of the machine's
    std::vector<Part> host;    // of the machine's memory, as long as the simulation is there
    std::uint64_t work = 0;    // on top of that for a time: while it is made, and for the command that copies most
    // With the first viewer, or a recording; for each tier that is watched or recorded. On the device, on the host.
    std::uint64_t orderArrays = 0, order = 0;
    std::uint64_t tierArrays = 0, tier = 0;

    [[nodiscard]] std::uint64_t onHost() const;     // the sum of `host`
    [[nodiscard]] std::vector<Part> parts() const;  // all of it, in words for users
};

Need needOf(const Plan& plan);

// What `plan` takes of the machine's memory when it is made on `device`.
std::uint64_t arraysOnHost(const compute::Device& device, const Plan& plan);

// For the states of so many spheres, until they are there.
Result<memory::Claim> claimForState(std::size_t spheres);
// For the simulation of a scene that is in memory already.
Result<memory::Claim> claimFor(const compute::Device& device, const Plan& plan);
// Once all of it has been made: what is held, and the promise of what its commands need.
void settle(memory::Claim& claim, const compute::Device& device, const Plan& plan);

// Copies that are made, beside what `plan` holds, to give its spheres other arrays; and to add spheres between them.
std::uint64_t copiesToChange(const Plan& plan);
std::uint64_t copiesToSpawn(const Plan& plan);

}  // namespace spherule::sim
