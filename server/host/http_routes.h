#pragma once

#include <optional>
#include <string>

#include "host/metrics.h"
#include "host/page.h"
#include "host/status_board.h"
#include "host/watchdog.h"
#include "net/server.h"

namespace spherule::host {

// Answers GET: the page and its files, /recordings/NAME, /healthz, /readyz and /metrics. Used by the io thread.
class HttpRoutes {
  public:
    HttpRoutes(StatusBoard& board, const Watchdog& watchdog) : board_(board), watchdog_(watchdog) {}
    // Null if the page has no file at `path`.
    [[nodiscard]] const net::StaticFile* file(const std::string& path) const { return page_.find(path); }
    // The recording on the disk that `path` names, if this server has written and finished it.
    [[nodiscard]] std::optional<std::string> download(const std::string& path) const;
    // `counters`: of the server that calls.
    net::HttpAnswer get(const std::string& path, const net::Counters& counters);

  private:
    StatusBoard& board_;
    const Watchdog& watchdog_;
    Metrics metrics_;
    Page page_;
};

}  // namespace spherule::host
