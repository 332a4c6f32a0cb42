#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace spherule::load {

// What a process uses, from /proc.
struct Usage {
    double residentMiB = 0;
    double cpuSeconds = 0;  // since it began, all threads
    std::size_t descriptors = 0;
};

// Nothing where there is no such process, or it belongs to somebody else.
std::optional<Usage> usageOf(pid_t process);

// What the server uses over the time of a load.
struct ServerUsage {
    Usage before;  // anybody came
    std::vector<Usage> during;
    std::optional<Usage> after;  // all have left
};

}  // namespace spherule::load
