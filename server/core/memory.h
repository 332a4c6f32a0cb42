#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

// Accounts for large memory allocations of this program. Linux grants more memory than there is, and kills a process
// that uses it. So code must make a claim before a large allocation. Any thread.
namespace spherule::memory {

struct Room {
    std::uint64_t left = 0;   // bytes that may still be allocated
    std::uint64_t limit = 0;  // bytes in all
    const char* whose = "";   // source of the limit, as the beginning of a sentence: "its control group allows"
};

// Returns the least of three: available memory of the machine, limits of the control groups, and setLimit(). `root`
// contains proc/ and sys/.
Room room(const std::filesystem::path& root = "/");

// Sets the most memory that this program may hold (bytes). 0: only the machine and its control groups limit it.
void setLimit(std::uint64_t bytes);

// A reservation of memory: promised or allocated.
class Claim {
  public:
    // Reserves `bytes` for an allocation. Refused if they exceed the free memory minus all other promises. `where`:
    // place for the error. `what`: purpose of the memory, such as "a scene of 8 spheres".
    static Result<Claim> make(std::string where, std::string_view what, std::uint64_t bytes);

    Claim() = default;  // of 0 bytes
    Claim(Claim&& other) noexcept { *this = std::move(other); }
    Claim& operator=(Claim&& other) noexcept;
    ~Claim() { settle(0, 0); }

    // Updates the claim: `held` bytes are allocated while it exists, `promised` bytes will be.
    void settle(std::uint64_t held, std::uint64_t promised);

  private:
    std::uint64_t held_ = 0;
    std::uint64_t promised_ = 0;
};

// Sums of all claims (bytes).
struct Claimed {
    std::uint64_t held = 0;
    std::uint64_t promised = 0;
};
Claimed claimed();

// Formats a size as "310 MiB" or "3.20 GiB".
std::string sizeText(std::uint64_t bytes);

}  // namespace spherule::memory
