#pragma once

#include <array>
#include <chrono>
#include <string>

#include "core/throttle.h"
#include "net/counters.h"

namespace spherule::net {

// Counts what is turned away, and logs it: each cause at most once in ten seconds, so that nobody fills the disk with
// it. On the io thread.
class Refusals {
  public:
    explicit Refusals(Counters& counters) : counters_(counters) {}

    // `who`: an address, or an address and a name; printable.
    void add(Rejection cause, const std::string& who);

  private:
    Counters& counters_;
    std::array<Throttle, rejectionNames.size()> throttles_{};
};

}  // namespace spherule::net
