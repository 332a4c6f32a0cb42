#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

namespace spherule::compute::cpu {

// What this process may still take before the limits of its control groups (versions 1 and 2), which is how containers
// are given memory; nothing where there is no limit. Below `root` lie proc/ and sys/.
std::optional<std::size_t> roomInControlGroup(const std::filesystem::path& root = "/");

}  // namespace spherule::compute::cpu
