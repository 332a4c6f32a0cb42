#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <string>

#include "codec/rendition.h"

namespace spherule::net {

// Which chain a client is sent: the one it wants, or less while it does not keep up. Steps down after several losses in
// a short time, first in rate, then in precision, and up again after a quiet time, which gets longer each time that
// this was too early. One thread.
class RateController {
  public:
    using Clock = std::chrono::steady_clock;

    explicit RateController(Clock::time_point now) : quietSince_(now) {}

    // What the client wants; `fixed`: and nothing less. False where it wanted that before.
    bool setTarget(const codec::Rendition& rendition, bool fixed, Clock::time_point now);
    [[nodiscard]] const codec::Rendition& rendition() const { return rendition_; }
    [[nodiscard]] bool reduced() const { return rendition_ != target_; }

    // The reason for a change of rendition(), where there is one.
    std::optional<std::string> onLoss(Clock::time_point now);  // the client missed a frame
    // `drawRate`: pictures per second, 0: unknown.
    std::optional<std::string> onAck(double drawRate, double decodeMs, Clock::time_point now);
    std::optional<std::string> onTick(Clock::time_point now);  // some time has

  private:
    bool stepDown(Clock::time_point now);
    bool stepUp(Clock::time_point now);

    codec::Rendition target_;
    codec::Rendition rendition_;
    bool fixed_ = false;
    std::deque<Clock::time_point> losses_;
    std::deque<codec::Rendition> higher_;  // on the way down, for the way up
    Clock::time_point quietSince_;
    Clock::time_point steppedUp_{};  // a loss soon after it says that it was too early
    std::chrono::seconds patience_{10};
    int slowAcks_ = 0;  // in a row
};

}  // namespace spherule::net
