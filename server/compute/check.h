#pragma once

#include <cstddef>
#include <string>

#include "compute/device.h"

namespace spherule::compute {

// Reports a program error that would compute wrong results: logs `message`, then aborts the program.
[[noreturn]] void programError(const std::string& message);

// Calls programError() if `bytes` bytes from `offset` on are not within the buffer. `what`: name of the operation, for
// the message.
void checkRange(const char* what, const Buffer& buffer, std::size_t offset, std::size_t bytes);

}  // namespace spherule::compute
