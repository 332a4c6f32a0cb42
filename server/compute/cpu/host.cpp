#include "compute/cpu/host.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace spherule::compute::cpu {

std::string processorName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("model name")) continue;
        const auto start = line.find(": ");
        if (start != std::string::npos) return line.substr(start + 2);
    }
    return "CPU";
}

unsigned processors() {
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(std::max(CPU_COUNT(&set), 1));
    return static_cast<unsigned>(std::max(sysconf(_SC_NPROCESSORS_ONLN), 1L));
}

unsigned mostLanes() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd"))
        return 16;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) return 8;
#endif
    return 4;
}

std::size_t memoryBytes() {
    return static_cast<std::size_t>(std::max(sysconf(_SC_PHYS_PAGES), 1L)) *
           static_cast<std::size_t>(std::max(sysconf(_SC_PAGESIZE), 1L));
}

}  // namespace spherule::compute::cpu
