#include "app/serving.h"

#include <fmt/format.h>
#include <pthread.h>

#include <csignal>
#include <cstdio>

#include "app/endpoint.h"
#include "app/exit_codes.h"
#include "app/options.h"
#include "app/runtime.h"
#include "core/log.h"

namespace spherule::app {

namespace {

// SIGINT and SIGTERM, blocked in all threads so that main can wait for them.
class StopSignals {
  public:
    StopSignals() {
        sigemptyset(&set_);
        sigaddset(&set_, SIGINT);
        sigaddset(&set_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    }
    // False when none came within a fifth of a second.
    [[nodiscard]] bool wait() const {
        const timespec timeout{0, 200'000'000};
        return sigtimedwait(&set_, nullptr, &timeout) > 0;
    }
    // From here on they end the program at once.
    void release() const { pthread_sigmask(SIG_UNBLOCK, &set_, nullptr); }

  private:
    sigset_t set_{};
};

void announce(const Runtime& runtime, const Endpoint& endpoint, const std::string& what) {
    const LiveReport live = runtime.report();
    const bool any = endpoint.host == "0.0.0.0" || endpoint.host == "::";
    const std::string host = any ? "127.0.0.1" : endpoint.host;
    const std::string shown = host.find(':') == std::string::npos ? host : "[" + host + "]";
    fmt::print("spherule {} {} ({} spheres) on {}\n  {}\n  stop with Ctrl-C\n  open http://{}:{}/\n", what, live.scene,
               live.spheres, live.device.renderer, live.device.reason, shown, runtime.port());
    std::fflush(stdout);
}

}  // namespace

int serveUntilStopped(const OpenShow& open, const std::string& listen, const std::string& what) {
    const auto endpoint = endpointOf(listen);
    if (!endpoint) return report(endpoint.error());
    const StopSignals signals;
    net::Options options;
    options.host = endpoint->host;
    options.port = endpoint->port;
    auto runtime = Runtime::start(open, options);
    if (!runtime) return report(runtime.error());
    announce(**runtime, *endpoint, what);
    bool stopped = false;
    while (!stopped && !(*runtime)->failure()) stopped = signals.wait();
    signals.release();
    if (stopped) spdlog::info("stopping; a second signal ends it at once");
    (*runtime)->drain();
    const auto failure = (*runtime)->failure();  // at the end, too
    return failure ? report(*failure) : exitDone;
}

}  // namespace spherule::app
