#pragma once

#include <string>

#include "app/live.h"
#include "app/metrics.h"
#include "app/watchdog.h"
#include "net/server.h"

namespace spherule::app {

// Answers GET: the page and its files, /healthz, /readyz and /metrics. Used by the io thread.
class Site {
  public:
    Site(Live& live, const Watchdog& watchdog) : live_(live), watchdog_(watchdog) {}
    // `counters`: of the server that calls.
    net::HttpAnswer get(const std::string& path, const net::Counters& counters);

  private:
    Live& live_;
    const Watchdog& watchdog_;
    Metrics metrics_;
};

}  // namespace spherule::app
