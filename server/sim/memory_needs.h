#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compute/device.h"
#include "core/memory.h"
#include "sim/plan.h"

// The memory of simulations, as far as it grows with the number of spheres. It is computed before any of it is
// allocated.
namespace spherule::sim {

struct MemoryNeeds {
    std::uint64_t arrays = 0;      // the plan's arrays on the device; host memory if the device has none of its own
    std::vector<MemoryPart> host;  // host memory, as long as the simulation exists
    std::uint64_t temporary = 0;   // host memory in addition, while it is made or executes the command that copies most

    [[nodiscard]] std::uint64_t onHost() const;           // the sum of `host`
    [[nodiscard]] std::vector<MemoryPart> parts() const;  // all of it, with names for users
};

MemoryNeeds memoryNeedsOf(const Plan& plan);

// Returns the host memory (bytes) of the plan's arrays on `device`.
std::uint64_t arraysOnHost(const compute::Device& device, const Plan& plan);

// Claims memory for the states of the spheres of a scene. Hold the claim until they are allocated.
Result<memory::Claim> claimForState(const scene::Scene& scene);
// Claims memory for the simulation of a scene that is in memory already.
Result<memory::Claim> claimFor(const compute::Device& device, const Plan& plan);
// Updates the claim once the simulation is made: its memory is held, and the memory for its commands is promised.
void settleClaim(memory::Claim& claim, const compute::Device& device, const Plan& plan);

// Return the memory (bytes) for copies in addition to the memory of `plan`: to give its spheres other arrays, and to
// add spheres.
std::uint64_t copiesToChange(const Plan& plan);
std::uint64_t copiesToSpawn(const Plan& plan);
// The same to hash the state of the spheres.
std::uint64_t copiesToHash(const Plan& plan);

}  // namespace spherule::sim
