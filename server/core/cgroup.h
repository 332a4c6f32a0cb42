#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace spherule::memory {

// Of the control group that leaves this process the least: versions 1 and 2, and the groups that it lies in.
struct GroupRoom {
    std::uint64_t left = 0;   // bytes that may still be taken
    std::uint64_t limit = 0;  // bytes in all
};

// Nothing where no control group limits memory. Containers are given memory this way. Below `root` lie proc/ and sys/.
std::optional<GroupRoom> roomInControlGroup(const std::filesystem::path& root = "/");

}  // namespace spherule::memory
