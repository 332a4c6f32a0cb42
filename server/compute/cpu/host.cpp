#include "compute/cpu/host.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "compute/cpu/cgroup.h"

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

std::size_t memoryBytes() {
    return static_cast<std::size_t>(std::max(sysconf(_SC_PHYS_PAGES), 1L)) *
           static_cast<std::size_t>(std::max(sysconf(_SC_PAGESIZE), 1L));
}

namespace {

std::size_t availableOnHost() {
    std::ifstream file("/proc/meminfo");
    for (std::string key; file >> key;) {
        std::size_t kibibytes = 0;
        if (key == "MemAvailable:" && file >> kibibytes) return kibibytes * 1024;
    }
    return memoryBytes();
}

}  // namespace

std::size_t availableBytes() {
    const std::size_t here = availableOnHost();
    return std::min(here, roomInControlGroup().value_or(here));
}

}  // namespace spherule::compute::cpu
