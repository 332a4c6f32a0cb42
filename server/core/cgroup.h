#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace spherule::memory {

// Memory of the control group with the least room, of versions 1 and 2, including parent groups.
struct GroupRoom {
    std::uint64_t left = 0;   // bytes that may still be allocated
    std::uint64_t limit = 0;  // bytes in all
};

// nullopt if no control group limits memory. Containers limit memory this way. `root` contains proc/ and sys/. Any
// thread.
std::optional<GroupRoom> roomInControlGroup(const std::filesystem::path& root = "/");

}  // namespace spherule::memory
