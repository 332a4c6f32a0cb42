#pragma once

#include <string>

#include "app/live.h"
#include "app/metrics.h"
#include "net/server.h"

namespace spherule::app {

// What GET answers: the page and its files, /healthz, /readyz and /metrics. Used by the io thread.
class Site {
  public:
    explicit Site(Live& live) : live_(live) {}
    // `counters` are those of the server that asks.
    net::HttpAnswer get(const std::string& path, const net::Counters& counters);

  private:
    Live& live_;
    Metrics metrics_;
};

}  // namespace spherule::app
