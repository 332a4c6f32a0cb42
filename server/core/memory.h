#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

// What this program may take of the machine's memory, and what has been promised of it. Linux hands out more than there
// is, and ends who then uses it: whoever is about to take much asks here first. Any thread.
namespace spherule::memory {

struct Room {
    std::uint64_t left = 0;   // bytes that may still be taken
    std::uint64_t limit = 0;  // bytes in all
    const char* whose = "";   // what sets the limit, as the beginning of a sentence: "its control group allows"
};

// The narrowest of three: what the machine has available, the limits of the control groups, and setLimit(). Below
// `root` lie proc/ and sys/.
Room room(const std::filesystem::path& root = "/");

// The most that this program may hold, in bytes; 0: what the machine and its control groups allow.
void setLimit(std::uint64_t bytes);

// Memory that somebody has been promised, or holds.
class Claim {
  public:
    // Of `bytes` that are about to be taken. Refused, with what is needed and what the limit is, where they and all
    // that others have been promised are more than is left. `where` is that of the error; `what` the memory is for: "a
    // scene of 8 spheres".
    static Result<Claim> make(std::string where, std::string_view what, std::uint64_t bytes);

    Claim() = default;  // of nothing
    Claim(Claim&& other) noexcept { *this = std::move(other); }
    Claim& operator=(Claim&& other) noexcept;
    ~Claim() { settle(0, 0); }

    // By now `held` have been taken, for as long as this is there, and `promised` are still to come.
    void settle(std::uint64_t held, std::uint64_t promised);

  private:
    std::uint64_t held_ = 0;
    std::uint64_t promised_ = 0;
};

// All claims there are.
struct Claimed {
    std::uint64_t held = 0;
    std::uint64_t promised = 0;
};
Claimed claimed();

// "310 MiB", "3.20 GiB".
std::string sizeText(std::uint64_t bytes);

}  // namespace spherule::memory
