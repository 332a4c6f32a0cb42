#pragma once

#include <array>
#include <chrono>
#include <string>

#include "core/throttle.h"
#include "net/counters.h"

namespace spherule::net {

// Counts and logs rejected requests and ended sessions. Logs each cause at most once in 10 s, so that clients cannot
// fill the disk. Used on the io thread.
class RejectionLog {
  public:
    explicit RejectionLog(Counters& counters) : counters_(counters) {}

    // `peer`: an address, or an address and a client name; printable.
    void rejected(RejectReason cause, const std::string& peer);
    // Records the end of a session that had started.
    void ended(CloseCause cause, const std::string& peer);

  private:
    Counters& counters_;
    std::array<Throttle, rejectReasonNames.size()> throttles_{};
    std::array<Throttle, closeCauseNames.size()> endThrottles_{};
};

}  // namespace spherule::net
