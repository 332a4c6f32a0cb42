#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "chain_check.h"

namespace spherule::load {

// How a viewer behaves.
enum class Kind : std::uint8_t {
    Healthy,       // reads at once, acknowledges each frame
    SlowReading,   // takes so many bytes per second
    LateAcking,    // reads at once, acknowledges late
    Stalled,       // reads no more after its first frame
    Reconnecting,  // leaves every few seconds, with and without a goodbye, and joins again
};

constexpr std::array<std::string_view, 5> kindNames = {"healthy", "slow reading", "late acking", "stalled",
                                                       "reconnecting"};

// What happened to the viewers of one kind.
struct Tally {
    std::uint64_t viewers = 0;
    std::uint64_t joins = 0;
    std::uint64_t bytes = 0;          // of messages, once all had joined
    std::uint64_t frames = 0;         // the same
    Received received;                // ever
    std::vector<std::uint32_t> ages;  // microseconds, once all had joined
    std::map<std::string, int> ends;  // of sessions that the viewer did not end itself: close code or error
    std::vector<std::string> faults;  // the first few
    std::uint64_t faultCount = 0;

    void fault(std::string what);
    void operator+=(const Tally& other);
};

using Tallies = std::array<Tally, kindNames.size()>;

// The value that so many of `sorted` are not above, 0 < part <= 1; 0 where there are none.
double percentile(const std::vector<std::uint32_t>& sorted, double part);

}  // namespace spherule::load
