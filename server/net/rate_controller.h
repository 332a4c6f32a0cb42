#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <string>

#include "codec/rendition.h"

namespace spherule::net {

// Chooses the rendition that a client is sent: the requested one, or a lower one while the client does not keep up.
// Steps down after several losses in a short time, first in rate, then in precision. Steps up after a quiet time, which
// doubles when a step up was too early. Used by one thread.
class RateController {
  public:
    using Clock = std::chrono::steady_clock;

    explicit RateController(Clock::time_point now) : quietSince_(now) {}

    // Sets the rendition that the client requests. `fixed`: never send a lower one. Returns false when nothing changes.
    bool setTarget(const codec::Rendition& rendition, bool fixed, Clock::time_point now);
    [[nodiscard]] const codec::Rendition& rendition() const { return rendition_; }
    [[nodiscard]] bool reduced() const { return rendition_ != target_; }

    // Each returns the reason when it changes rendition(), else nullopt.
    std::optional<std::string> onLoss(Clock::time_point now);  // the client missed a frame
    // `drawRate`: pictures per second, 0 if unknown. `decodeMs`: time to decode a frame (ms).
    std::optional<std::string> onAck(double drawRate, double decodeMs, Clock::time_point now);
    std::optional<std::string> onTick(Clock::time_point now);  // call about once a second

  private:
    bool stepDown(Clock::time_point now);
    bool stepUp(Clock::time_point now);

    codec::Rendition target_;
    codec::Rendition rendition_;
    bool fixed_ = false;
    std::deque<Clock::time_point> losses_;
    std::deque<codec::Rendition> higher_;  // renditions to return to, the next one last
    Clock::time_point quietSince_;
    Clock::time_point steppedUp_{};      // time of the last step up
    std::chrono::seconds patience_{10};  // quiet time before a step up
    int slowAcks_ = 0;                   // in a row
};

}  // namespace spherule::net
