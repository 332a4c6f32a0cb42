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

// Behaviour of a viewer.
enum class Kind : std::uint8_t {
    Healthy,       // reads at once, acknowledges each frame
    SlowReading,   // reads a fixed number of bytes per second
    LateAcking,    // reads at once, acknowledges late
    Stalled,       // stops reading after its first frame
    Reconnecting,  // reconnects every few seconds, with and without a close frame
};

constexpr std::array<std::string_view, 5> kindNames = {"healthy", "slow reading", "late acking", "stalled",
                                                       "reconnecting"};

// Counts of the viewers of one kind.
struct Tally {
    std::uint64_t viewers = 0;
    std::uint64_t joins = 0;
    std::uint64_t bytes = 0;          // of messages, after all viewers have connected
    std::uint64_t frames = 0;         // after all viewers have connected
    Received received;                // since the start
    std::vector<std::uint32_t> ages;  // of frames (microseconds), after all viewers have connected
    std::map<std::string, int> ends;  // sessions that the viewer did not end, by close code or error
    std::vector<std::string> faults;  // the first faults
    std::uint64_t faultCount = 0;

    void fault(std::string what);
    void operator+=(const Tally& other);
};

using Tallies = std::array<Tally, kindNames.size()>;

// Returns the quantile `part` of sorted values, 0 < part <= 1; 0 if there are no values.
double percentile(const std::vector<std::uint32_t>& sorted, double part);

}  // namespace spherule::load
