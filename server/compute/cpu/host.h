#pragma once

#include <cstddef>
#include <string>

// What there is to run on.
namespace spherule::compute::cpu {

std::string processorName();   // "CPU" where the system does not say
unsigned processors();         // that this process may use, at least 1
std::size_t memoryBytes();     // of the machine
std::size_t availableBytes();  // of it, to new allocations of this process and its control groups

}  // namespace spherule::compute::cpu
