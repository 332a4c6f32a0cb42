#include "core/cgroup.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace spherule::memory {
namespace {

namespace fs = std::filesystem;

struct Names {
    const char* limit;
    const char* used;
    const char* reclaimable;  // key in memory.stat: file cache that the kernel frees on demand
};
constexpr Names version2{.limit = "memory.max", .used = "memory.current", .reclaimable = "inactive_file"};
constexpr Names version1{
    .limit = "memory.limit_in_bytes", .used = "memory.usage_in_bytes", .reclaimable = "total_inactive_file"};

// nullopt if the file is missing or has no number ("max").
std::optional<std::uint64_t> number(const fs::path& path) {
    std::ifstream file(path);
    std::uint64_t value = 0;
    if (file >> value) return value;
    return std::nullopt;
}

std::uint64_t reclaimable(const fs::path& path, const std::string& wanted) {
    std::ifstream file(path);
    std::uint64_t value = 0;
    for (std::string name; file >> name >> value;)
        if (name == wanted) return value;
    return 0;
}

void narrow(std::optional<GroupRoom>& least, const GroupRoom& room) {
    if (!least || room.left < least->left) least = room;
}

// Least room of the group and its parents.
std::optional<GroupRoom> roomIn(const fs::path& mount, const fs::path& group, const Names& names) {
    std::optional<GroupRoom> least;
    fs::path folder = group.relative_path();
    while (true) {
        const auto limit = number(mount / folder / names.limit);
        const auto used = number(mount / folder / names.used);
        if (limit && used) {
            const std::uint64_t held =
                *used - std::min(*used, reclaimable(mount / folder / "memory.stat", names.reclaimable));
            narrow(least, {.left = *limit - std::min(*limit, held), .limit = *limit});
        }
        if (folder.empty()) return least;
        folder = folder.parent_path();
    }
}

}  // namespace

std::optional<GroupRoom> roomInControlGroup(const fs::path& root) {
    std::ifstream groups(root / "proc/self/cgroup");
    std::optional<GroupRoom> least;
    // "0::/group" in version 2, "4:memory:/group" in version 1.
    for (std::string line; std::getline(groups, line);) {
        const auto path = line.rfind(':');
        if (path == std::string::npos) continue;
        const bool second = line.starts_with("0::");
        if (!second && line.find(":memory:") == std::string::npos) continue;
        const auto mount = root / (second ? "sys/fs/cgroup" : "sys/fs/cgroup/memory");
        const auto room = roomIn(mount, line.substr(path + 1), second ? version2 : version1);
        if (room) narrow(least, *room);
    }
    return least;
}

}  // namespace spherule::memory
