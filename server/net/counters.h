#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "net/reject_reason.h"

namespace spherule::net {

// Why a session ended.
enum class CloseCause : std::uint8_t {
    Left,         // the client closed, with or without a close frame
    NoHello,      // 1008: the first message was no hello, came too late, or a second hello came
    NoToken,      // 4401: missing or unknown token
    Full,         // 1013: limit of sessions
    Undecodable,  // 1007
    TooBig,       // 1009
    Protocol,     // 1002: not WebSocket
    Overflow,     // 1013: the send queue was full
    Stalled,      // dropped: a write made no progress
    Silent,       // dropped: no data from the peer
    Drained,      // 1012: the server stops
    Fault,        // dropped: out of memory, or an internal error
};

constexpr std::array<std::string_view, 12> closeCauseNames = {"left",        "no_hello", "no_token", "full",
                                                              "undecodable", "too_big",  "protocol", "overflow",
                                                              "stalled",     "silent",   "drained",  "fault"};

// Counters for metrics. Written by the io thread, read by any thread.
struct Counters {
    using Count = std::atomic<std::uint64_t>;

    Count sessions = 0;  // open now
    Count accepted = 0;  // since the start
    Count httpRequests = 0;
    Count commands = 0;
    Count framesSent = 0;
    Count chainsLost = 0;  // a session could not send the previous frame in time, or its client could not decode it
    Count bytesSent = 0;   // payload of messages
    std::array<Count, closeCauseNames.size()> closed{};      // by CloseCause
    std::array<Count, rejectReasonNames.size()> rejected{};  // by RejectReason

    Count& closedBy(CloseCause cause) { return closed[static_cast<std::size_t>(cause)]; }
    Count& rejectedFor(RejectReason cause) { return rejected[static_cast<std::size_t>(cause)]; }
    [[nodiscard]] const Count& rejectedFor(RejectReason cause) const {
        return rejected[static_cast<std::size_t>(cause)];
    }
    [[nodiscard]] const Count& closedBy(CloseCause cause) const { return closed[static_cast<std::size_t>(cause)]; }
};

}  // namespace spherule::net
