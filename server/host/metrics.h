#pragma once

#include <memory>
#include <string>

#include "host/status_board.h"
#include "net/counters.h"

namespace spherule::host {

// The page /metrics: figures of the simulation and the network in a prometheus-cpp registry. Used by one thread.
class Metrics {
  public:
    Metrics();
    ~Metrics();
    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    std::string text(const ServerStatus& status, const net::Counters& net);

  private:
    void addDiagnostics(const v1::Diagnostics& diagnostics);

    struct Families;
    std::unique_ptr<Families> families_;
};

}  // namespace spherule::host
