#pragma once

#include <array>
#include <chrono>
#include <string>

#include "core/throttle.h"
#include "net/counters.h"

namespace spherule::net {

// Counts what is turned away and what ends, and logs it: each cause at most once in ten seconds, so that nobody fills
// the disk with it. On the io thread.
class RejectionLog {
  public:
    explicit RejectionLog(Counters& counters) : counters_(counters) {}

    // `who`: an address, or an address and a name; printable.
    void rejected(RejectReason cause, const std::string& who);
    // A session that had begun.
    void ended(CloseCause cause, const std::string& who);

  private:
    Counters& counters_;
    std::array<Throttle, rejectReasonNames.size()> throttles_{};
    std::array<Throttle, closeCauseNames.size()> endThrottles_{};
};

}  // namespace spherule::net
