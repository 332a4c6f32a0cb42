#include "app/serving.h"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

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
    // False when none came within so many ms.
    [[nodiscard]] bool wait(long patience) const {
        const timespec timeout{0, patience * 1'000'000};
        return sigtimedwait(&set_, nullptr, &timeout) > 0;
    }
    // From here on they end the program at once, also where it is the first of a container, whom the system would not
    // end by itself.
    void release() const {
        struct sigaction now {};
        now.sa_handler = [](int signal) { _exit(exitBySignal + signal); };
        sigaction(SIGINT, &now, nullptr);
        sigaction(SIGTERM, &now, nullptr);
        pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
    }

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

int serveUntilStopped(const OpenShow& open, const std::string& listen, double watchdog, const std::string& what) {
    const auto endpoint = endpointOf(listen);
    if (!endpoint) return report(endpoint.error());
    const StopSignals signals;
    net::Options options;
    options.host = endpoint->host;
    options.port = endpoint->port;
    auto runtime = Runtime::start(open, options, Watchdog::Seconds(watchdog));
    if (!runtime) return report(runtime.error());
    bool stopped = false;
    while (!stopped && !(*runtime)->opened() && !(*runtime)->failure()) stopped = signals.wait(10);
    const bool opened = (*runtime)->opened();
    if (opened && !stopped) announce(**runtime, *endpoint, what);
    while (!stopped && !(*runtime)->failure()) stopped = signals.wait(200);
    signals.release();
    if (stopped && !opened) {
        spdlog::info("stopped before the scene was there");
        endNow(exitDone);  // nobody watches, and nothing is recorded
    }
    if (stopped) spdlog::info("stopping; a second signal ends it at once");
    const bool clean = (*runtime)->drain();
    const auto failure = (*runtime)->failure();  // at the end, too
    int exitCode = exitDone;
    if (failure) exitCode = report(*failure);
    if (clean) return exitCode;
    if (!failure) exitCode = report({ErrorKind::DeviceLost, "step", "the one under way did not end in time"});
    endNow(exitCode);
}

}  // namespace spherule::app
