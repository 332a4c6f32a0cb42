#include "app/serving.h"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "app/exit_codes.h"
#include "app/options.h"
#include "app/runtime.h"
#include "core/log.h"

namespace spherule::app {

namespace {

// SIGINT, SIGTERM and SIGHUP, blocked in all threads so that main can wait for them.
class Signals {
  public:
    Signals() {
        sigemptyset(&set_);
        sigaddset(&set_, SIGINT);
        sigaddset(&set_, SIGTERM);
        sigaddset(&set_, SIGHUP);
        pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    }
    // Waits up to `patience` (ms). Returns the signal; -1 if none came.
    [[nodiscard]] int wait(long patience) const {
        const timespec timeout{0, patience * 1'000'000};
        return sigtimedwait(&set_, nullptr, &timeout);
    }
    // From now on, SIGINT and SIGTERM end the program at once. The handler is for the first process of a container,
    // which the default action would not end.
    void release() const {
        struct sigaction now {};
        std::signal(SIGHUP, SIG_IGN);
        now.sa_handler = [](int signal) { _exit(exitBySignal + signal); };
        sigaction(SIGINT, &now, nullptr);
        sigaction(SIGTERM, &now, nullptr);
        pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
    }

  private:
    sigset_t set_{};
};

std::string_view doorOf(const net::Options& options) {
    if (options.open) return "everybody who reaches it may watch and command";
    if (!net::requiresToken(options.credentials)) return "only this machine reaches it";
    return options.credentials.controllerToken.empty() ? "it asks for a token; nobody may command"
                                                       : "it asks for a token";
}

void announce(const Runtime& runtime, const net::Options& options, const std::string& what) {
    const LiveReport live = runtime.report();
    const bool any = options.host == "0.0.0.0" || options.host == "::";
    const std::string host = any ? "127.0.0.1" : options.host;
    const std::string shown = host.find(':') == std::string::npos ? host : "[" + host + "]";
    fmt::print("spherule {} {} ({} spheres) on {}\n  {}\n  {}\n  stop with Ctrl-C\n  open {}://{}:{}/\n", what,
               live.scene, live.spheres, live.device.renderer, live.device.reason, doorOf(options),
               options.credentials.certificate.empty() ? "http" : "https", shown, runtime.port());
    std::fflush(stdout);
}

// Replaces tokens and certificate. After an error the old ones stay.
void reload(Runtime& runtime, const ServingOptions& options) {
    const auto credentials = credentialsOf(options);
    const auto done = credentials ? runtime.setCredentials(*credentials) : tl::unexpected(credentials.error());
    if (done)
        spdlog::info("tokens and certificate have been read anew, for those who come from now on");
    else
        spdlog::error("tokens and certificate stay as they were: {}", done.error().text());
}

}  // namespace

int serveUntilStopped(const OpenShow& open, const ServingOptions& serving, const std::string& what) {
    const auto options = netOptionsOf(serving);
    if (!options) return report(options.error());
    const Signals signals;
    logInBackground();
    auto runtime = Runtime::start(open, *options, Watchdog::Seconds(serving.watchdog));
    if (!runtime) return report(runtime.error());
    // Waits for a signal up to `patience` (ms). Returns true when the program has to stop.
    const auto stopsWithin = [&](long patience) {
        const int signal = signals.wait(patience);
        // Without credential files, SIGHUP means that the terminal has closed.
        if (signal != SIGHUP || !hasFiles(serving)) return signal > 0;
        reload(**runtime, serving);
        return false;
    };
    bool stopped = false;
    while (!stopped && !(*runtime)->opened() && !(*runtime)->failure()) stopped = stopsWithin(10);
    const bool opened = (*runtime)->opened();
    if (opened && !stopped) announce(**runtime, *options, what);
    while (!stopped && !(*runtime)->failure()) stopped = stopsWithin(200);
    signals.release();
    if (stopped && !opened) {
        spdlog::info("stopped before the scene was there");
        endNow(exitDone);  // there are no viewers and no recording
    }
    if (stopped) spdlog::info("stopping; a second signal ends it at once");
    const bool clean = (*runtime)->drain();
    const auto failure = (*runtime)->failure();  // may have come during drain()
    int exitCode = exitDone;
    if (failure) exitCode = report(*failure);
    if (clean && logIsWritten()) return exitCode;
    if (!clean && !failure) exitCode = report({ErrorKind::DeviceLost, "step", "the one under way did not end in time"});
    endNow(exitCode);
}

}  // namespace spherule::app
