#include "net/session_timeouts.h"

#include <algorithm>

namespace spherule::net {

namespace {

constexpr int checksPerLimit = 8;
constexpr SessionTimeouts::Duration longestInterval{1000};
constexpr SessionTimeouts::Duration shortestInterval{10};

}  // namespace

SessionTimeouts::SessionTimeouts(const Limits& limits, Clock::time_point now)
    : limits_(limits), began_(now), alive_(now), advanced_(now) {}

void SessionTimeouts::writeBegan(Clock::time_point now) {
    writing_ = true;
    advanced_ = now;
}

SessionTimeouts::Verdict SessionTimeouts::check(const TcpProgress& progress, Clock::time_point now) {
    const bool heard = progress.received != seen_.received;
    const bool acknowledged = progress.acknowledged != seen_.acknowledged;
    seen_ = progress;
    if (acknowledged) advanced_ = now;
    // The peer's kernel confirms small messages even if its program hangs. A confirmation shows that the program reads
    // only while a write is larger than the kernel's buffers.
    if (heard || (acknowledged && writing_)) {
        alive_ = now;
        pinged_ = false;
    }
    if (closeBegan_) return now - *closeBegan_ > limits_.progress ? Verdict::Stalled : Verdict::Fine;
    if (!helloDone_ && now - began_ > limits_.hello) return Verdict::NoHello;
    if (writing_ && now - advanced_ > limits_.progress) return Verdict::Stalled;
    if (now - alive_ > limits_.idle) return Verdict::Silent;
    if (!pinged_ && now - alive_ > limits_.idle / 2) {
        pinged_ = true;
        return Verdict::Ping;
    }
    return Verdict::Fine;
}

SessionTimeouts::Duration SessionTimeouts::interval() const {
    const Duration shortest = std::min({limits_.hello, limits_.progress, limits_.idle});
    return std::clamp(shortest / checksPerLimit, shortestInterval, longestInterval);
}

}  // namespace spherule::net
