#pragma once

#include <cstddef>
#include <string>

// What there is to run on.
namespace spherule::compute::cpu {

std::string processorName();  // "CPU" where the system does not say
unsigned processors();        // that this process may use, at least 1
std::size_t memoryBytes();    // of the machine

}  // namespace spherule::compute::cpu
