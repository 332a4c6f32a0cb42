#include "net/credit.h"

#include <algorithm>

namespace spherule::net {

namespace {

constexpr std::size_t fewest = 3;
constexpr std::uint32_t perSecond = 4;  // parts of a second's frames that may be on their way
constexpr std::size_t remembered = 64;
constexpr std::chrono::seconds forgotten{1};

}  // namespace

void Credit::setRate(std::uint32_t rate) {
    most_ = std::max<std::size_t>(fewest, rate / perSecond);
}

void Credit::sent(std::uint64_t sequence, Clock::time_point now) {
    last_ = now;
    underWay_.push_back(sequence);
    if (underWay_.size() > remembered) underWay_.pop_front();
}

void Credit::acked(std::uint64_t sequence) {
    acks_ = true;
    while (!underWay_.empty() && underWay_.front() <= sequence) underWay_.pop_front();
}

bool Credit::open(Clock::time_point now) const {
    return underWay_.size() < most_ || idle(now);
}

bool Credit::idle(Clock::time_point now) const {
    return !acks_ || underWay_.empty() || now - last_ >= forgotten;
}

}  // namespace spherule::net
