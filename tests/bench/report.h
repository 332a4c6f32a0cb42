#pragma once

#include <string>
#include <vector>

#include "compute/device.h"
#include "core/result.h"
#include "figures.h"

namespace spherule::bench {

// Date, device, machine and its load, command: one `name: value` per line.
std::vector<std::string> headerFor(const compute::DeviceInfo& info, const std::string& command);

std::string textOf(const std::vector<std::string>& header, const Figures& figures);
std::string markdownOf(const std::vector<std::string>& header, const Figures& figures);
// One line per figure: table,spheres,what,value,unit,note; the header as lines that start with #.
std::string csvOf(const std::vector<std::string>& header, const Figures& figures);

Result<void> writeFile(const std::string& path, const std::string& text);

}  // namespace spherule::bench
