#include "core/memory.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <limits>
#include <mutex>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "core/cgroup.h"

namespace spherule::memory {

namespace {

namespace fs = std::filesystem;

// Kept free at each claim, for page tables, stacks and messages (bytes).
constexpr std::uint64_t spareAlways = 24U << 20U;
constexpr std::uint64_t spareOf = 64;  // plus 1/64 of the limit
// Claims up to this size (bytes) are always granted: refusing them would not help.
constexpr std::uint64_t trifle = 1U << 20U;

std::atomic<std::uint64_t> ownLimit{0};
std::mutex mutex;  // protects `all`
Claimed all;

// Returns an entry of /proc/meminfo (bytes).
std::uint64_t figure(const fs::path& root, const std::string& wanted) {
    std::ifstream file(root / "proc/meminfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(wanted)) return std::stoull(line.substr(wanted.size())) * 1024;
    return std::numeric_limits<std::uint64_t>::max();
}

std::uint64_t heldByProcess(const fs::path& root) {
    std::ifstream file(root / "proc/self/statm");
    std::uint64_t size = 0;
    std::uint64_t resident = 0;  // pages
    file >> size >> resident;
    return resident * static_cast<std::uint64_t>(std::max(sysconf(_SC_PAGESIZE), 1L));
}

// Returns the part of room.left that no claim reserves.
std::uint64_t freeOf(const Room& room, std::uint64_t promised) {
    const std::uint64_t taken = promised + spareAlways + room.limit / spareOf;
    return room.left - std::min(room.left, taken);
}

}  // namespace

Room room(const fs::path& root) {
    Room least{.left = figure(root, "MemAvailable:"), .limit = figure(root, "MemTotal:"), .whose = "the machine has"};
    if (const auto group = roomInControlGroup(root); group && group->left < least.left)
        least = {.left = group->left, .limit = group->limit, .whose = "its control group allows"};
    if (const std::uint64_t most = ownLimit; most > 0) {
        const std::uint64_t left = most - std::min(most, heldByProcess(root));
        if (left < least.left) least = {.left = left, .limit = most, .whose = "--memory-limit allows"};
    }
    return least;
}

void setLimit(std::uint64_t bytes) {
    ownLimit = bytes;
}

Result<Claim> Claim::make(std::string where, std::string_view what, std::uint64_t bytes) {
    std::unique_lock lock(mutex);
    Room now = room();
    if (bytes > std::max(freeOf(now, all.promised), trifle)) {
        malloc_trim(0);  // return freed memory to the system first
        now = room();
    }
    const std::uint64_t left = freeOf(now, all.promised);
    if (bytes > std::max(left, trifle)) {
        const std::string others =
            all.held > 0 ? fmt::format(", of which what runs here holds {}", sizeText(all.held)) : "";
        return fail(ErrorKind::Refused, std::move(where),
                    fmt::format("{} more of memory are needed for {}, and {} are left: {} {}{}; use fewer spheres, or "
                                "give the program more memory",
                                sizeText(bytes), what, sizeText(left), now.whose, sizeText(now.limit), others),
                    Cause::NoMemory);
    }
    all.promised += bytes;
    lock.unlock();  // a claim's destructor locks the mutex
    Claim claim;
    claim.promised_ = bytes;
    return claim;
}

Claim& Claim::operator=(Claim&& other) noexcept {
    if (this == &other) return *this;
    settle(0, 0);
    held_ = std::exchange(other.held_, 0);
    promised_ = std::exchange(other.promised_, 0);
    return *this;
}

void Claim::settle(std::uint64_t held, std::uint64_t promised) {
    const std::lock_guard lock(mutex);
    all.held += held - held_;
    all.promised += promised - promised_;
    held_ = held;
    promised_ = promised;
}

Claimed claimed() {
    const std::lock_guard lock(mutex);
    return all;
}

std::string sizeText(std::uint64_t bytes) {
    constexpr double mebi = 1 << 20;
    const double size = static_cast<double>(bytes) / mebi;
    return size < 1024 ? fmt::format("{:.{}f} MiB", size, size < 10 ? 1 : 0) : fmt::format("{:.2f} GiB", size / 1024);
}

}  // namespace spherule::memory
