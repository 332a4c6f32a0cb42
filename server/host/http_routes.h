#pragma once

#include <string>

#include "host/metrics.h"
#include "host/status_board.h"
#include "host/watchdog.h"
#include "net/server.h"

namespace spherule::host {

// Answers GET: the page and its files, /healthz, /readyz and /metrics. Used by the io thread.
class HttpRoutes {
  public:
    HttpRoutes(StatusBoard& board, const Watchdog& watchdog) : board_(board), watchdog_(watchdog) {}
    // `counters`: of the server that calls.
    net::HttpAnswer get(const std::string& path, const net::Counters& counters);

  private:
    StatusBoard& board_;
    const Watchdog& watchdog_;
    Metrics metrics_;
};

}  // namespace spherule::host
