#pragma once

#include <cstddef>
#include <string>

#include "compute/device.h"

namespace spherule::compute {

// A mistake of ours that would compute wrong results: logged, then the program ends.
[[noreturn]] void programError(const std::string& message);

// Ends the program so when `bytes` from `offset` on are not within the buffer; `what` is what was to be done with them.
void checkRange(const char* what, const Buffer& buffer, std::size_t offset, std::size_t bytes);

}  // namespace spherule::compute
