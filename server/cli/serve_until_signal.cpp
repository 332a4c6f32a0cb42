#include "cli/serve_until_signal.h"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "core/log.h"
#include "host/host.h"

namespace spherule::cli {

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
    // Waits up to `timeout` (ms). Returns the signal; -1 if none came.
    [[nodiscard]] int wait(long timeout) const {
        const timespec longest{0, timeout * 1'000'000};
        return sigtimedwait(&set_, nullptr, &longest);
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

std::string_view accessText(const net::Options& options) {
    if (options.open) return "everybody who reaches it may watch and command";
    if (!net::requiresToken(options.credentials)) return "only this machine reaches it";
    return options.credentials.controllerToken.empty() ? "it asks for a token; nobody may command"
                                                       : "it asks for a token";
}

void announce(const host::Host& server, const net::Options& options, const std::string& what) {
    const host::ServerStatus status = server.status();
    const bool any = options.host == "0.0.0.0" || options.host == "::";
    const std::string host = any ? "127.0.0.1" : options.host;
    const std::string shown = host.find(':') == std::string::npos ? host : "[" + host + "]";
    fmt::print("spherule {} {} ({} spheres) on {}\n  {}\n  {}\n  stop with Ctrl-C\n  open {}://{}:{}/\n", what,
               status.scene, status.spheres, status.device.renderer, status.device.reason, accessText(options),
               options.credentials.certificate.empty() ? "http" : "https", shown, server.port());
    std::fflush(stdout);
}

// Replaces tokens and certificate. After an error the old ones stay.
void reload(host::Host& server, const ServerOptions& options) {
    const auto credentials = credentialsOf(options);
    const auto done = credentials ? server.setCredentials(*credentials) : tl::unexpected(credentials.error());
    if (done)
        spdlog::info("tokens and certificate have been read anew, for those who come from now on");
    else
        spdlog::error("tokens and certificate stay as they were: {}", done.error().text());
}

}  // namespace

int serveUntilSignal(const host::ProducerFactory& create, const ServerOptions& serving, const std::string& what) {
    const auto options = netOptionsOf(serving);
    if (!options) return printError(options.error());
    const Signals signals;
    logInBackground();
    auto server = host::Host::start(create, *options, host::Watchdog::Seconds(serving.watchdog), printError);
    if (!server) return printError(server.error());
    // Waits for a signal up to `timeout` (ms). Returns true when the program has to stop.
    const auto stopsWithin = [&](long timeout) {
        const int signal = signals.wait(timeout);
        // Without credential files, SIGHUP means that the terminal has closed.
        if (signal != SIGHUP || !hasFiles(serving)) return signal > 0;
        reload(**server, serving);
        return false;
    };
    bool stopped = false;
    while (!stopped && !(*server)->opened() && !(*server)->failure()) stopped = stopsWithin(10);
    const bool opened = (*server)->opened();
    if (opened && !stopped) announce(**server, *options, what);
    while (!stopped && !(*server)->failure()) stopped = stopsWithin(200);
    signals.release();
    if (stopped && !opened) {
        spdlog::info("stopped before the scene was there");
        host::endNow(exitDone);  // there are no viewers and no recording
    }
    if (stopped) spdlog::info("stopping; a second signal ends it at once");
    const bool clean = (*server)->drain();
    const auto failure = (*server)->failure();  // may have come during drain()
    int exitCode = exitDone;
    if (failure) exitCode = printError(*failure);
    if (clean && logIsWritten()) return exitCode;
    if (!clean && !failure) {
        const bool checkpoint = (*server)->status().checkpoints.has_value();
        exitCode = printError(
            checkpoint ? Error{ErrorKind::Refused, "checkpoint",
                               "the last one was not on the disk in time: the step before it, or the disk, is too slow"}
                       : Error{ErrorKind::DeviceLost, "step", "the one under way did not end in time"});
    }
    host::endNow(exitCode);
}

}  // namespace spherule::cli
