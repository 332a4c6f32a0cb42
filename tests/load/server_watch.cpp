#include "server_watch.h"

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace spherule::load {

// The fields of /proc/PID/stat are counted after the name, which may contain spaces and brackets: state is field 3.
std::optional<Usage> usageOf(pid_t process) {
    const std::filesystem::path folder = "/proc/" + std::to_string(process);
    std::ifstream file(folder / "stat");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto name = text.rfind(')');
    if (name == std::string::npos) return std::nullopt;
    std::istringstream fields(text.substr(name + 1));
    const std::vector<std::string> values{std::istream_iterator<std::string>(fields), {}};
    constexpr std::size_t user = 14 - 3, system = 15 - 3, resident = 24 - 3;
    if (values.size() <= resident) return std::nullopt;
    Usage usage;
    usage.cpuSeconds =
        (std::stod(values[user]) + std::stod(values[system])) / static_cast<double>(sysconf(_SC_CLK_TCK));
    usage.residentMiB = std::stod(values[resident]) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
    std::error_code error;
    for (auto at = std::filesystem::directory_iterator(folder / "fd", error);
         !error && at != std::filesystem::directory_iterator(); at.increment(error))
        ++usage.descriptors;
    if (error) return std::nullopt;
    return usage;
}

}  // namespace spherule::load
