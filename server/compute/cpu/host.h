#pragma once

#include <cstddef>
#include <string>

// The hardware of this host.
namespace spherule::compute::cpu {

std::string processorName();  // "CPU" if the system does not name it
unsigned processors();        // number that this process may use, at least 1
unsigned mostLanes();         // float32 numbers in a vector of the processor: 4, 8 or 16
std::size_t memoryBytes();    // of the machine

}  // namespace spherule::compute::cpu
