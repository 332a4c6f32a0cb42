#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/memory.h"
#include "sim/pipeline.h"

namespace spherule::sim {

// All that decides how a simulation goes on, between two steps. Simulation::save() makes it, and Simulation::restore()
// makes a simulation of it that goes on with the same bits.
struct SavedState {
    std::string host;                          // data on the host, see core/archive.h
    std::vector<Pipeline::SavedArray> arrays;  // of the device
    memory::Claim claim{};                     // for its memory

    [[nodiscard]] std::uint64_t bytes() const {
        std::uint64_t sum = host.size();
        for (const Pipeline::SavedArray& array : arrays) sum += array.bytes.size();
        return sum;
    }
};

}  // namespace spherule::sim
