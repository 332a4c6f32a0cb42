#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace spherule::load {

// Resources of a process, from /proc.
struct Usage {
    double residentMiB = 0;
    double cpuSeconds = 0;  // of all threads, since the start
    std::size_t descriptors = 0;
};

// nullopt if there is no such process, or it belongs to another user.
std::optional<Usage> usageOf(pid_t process);

// Resources of the server before, during and after the load.
struct ServerUsage {
    Usage before;  // the first connection
    std::vector<Usage> during;
    std::optional<Usage> after;  // the last disconnect
};

}  // namespace spherule::load
