#include "net/ack_window.h"

#include <algorithm>

namespace spherule::net {

namespace {

constexpr std::size_t minFrames = 3;           // limit at low rates
constexpr std::uint32_t windowsPerSecond = 4;  // the limit is 1/4 s of frames
constexpr std::size_t maxRemembered = 64;
constexpr std::chrono::seconds expiry{1};

}  // namespace

void AckWindow::setRate(std::uint32_t rate) {
    limit_ = std::max<std::size_t>(minFrames, rate / windowsPerSecond);
}

void AckWindow::sent(std::uint64_t sequence, Clock::time_point now) {
    lastSent_ = now;
    unacknowledged_.push_back(sequence);
    if (unacknowledged_.size() > maxRemembered) unacknowledged_.pop_front();
}

void AckWindow::acked(std::uint64_t sequence) {
    clientAcks_ = true;
    while (!unacknowledged_.empty() && unacknowledged_.front() <= sequence) unacknowledged_.pop_front();
}

bool AckWindow::open(Clock::time_point now) const {
    return unacknowledged_.size() < limit_ || idle(now);
}

bool AckWindow::idle(Clock::time_point now) const {
    return !clientAcks_ || unacknowledged_.empty() || now - lastSent_ >= expiry;
}

}  // namespace spherule::net
