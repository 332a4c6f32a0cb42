#include "compute/check.h"

#include <cstdlib>

#include <spdlog/fmt/fmt.h>

#include "core/log.h"

namespace spherule::compute {

void programError(const std::string& message) {
    spdlog::critical("program error: {}", message);
    spdlog::default_logger()->flush();
    std::abort();
}

void checkRange(const char* what, const Buffer& buffer, std::size_t offset, std::size_t bytes) {
    if (offset <= buffer.bytes() && bytes <= buffer.bytes() - offset) return;
    programError(fmt::format("{} of {} bytes at {} in a buffer of {}", what, bytes, offset, buffer.bytes()));
}

}  // namespace spherule::compute
