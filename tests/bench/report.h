#pragma once

#include <string>
#include <vector>

#include "compute/device.h"
#include "core/result.h"
#include "figures.h"

namespace spherule::bench {

// Returns date, device, machine, load and command, as lines `name: value`.
std::vector<std::string> headerFor(const compute::DeviceInfo& info, const std::string& command);

std::string textOf(const std::vector<std::string>& header, const Figures& figures);
std::string markdownOf(const std::vector<std::string>& header, const Figures& figures);
// Returns the header as lines that start with #, then one line per figure: table,spheres,what,value,unit,note.
std::string csvOf(const std::vector<std::string>& header, const Figures& figures);

Result<void> writeFile(const std::string& path, const std::string& text);

}  // namespace spherule::bench
