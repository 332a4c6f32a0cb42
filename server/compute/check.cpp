#include "compute/check.h"

#include <cstdlib>

#include "core/log.h"

namespace spherule::compute {

void programError(const std::string& message) {
    spdlog::critical("program error: {}", message);
    spdlog::default_logger()->flush();
    std::abort();
}

}  // namespace spherule::compute
