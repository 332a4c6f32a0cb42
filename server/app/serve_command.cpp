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

struct ServeOptions {
    SceneOptions scene;
    std::string listen = "127.0.0.1:8080";
    std::string table;
};

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

void announce(const ServeOptions& options, const Runtime& runtime, const Endpoint& endpoint) {
    const LiveReport live = runtime.report();
    const bool any = endpoint.host == "0.0.0.0" || endpoint.host == "::";
    const std::string host = any ? "127.0.0.1" : endpoint.host;
    const std::string shown = host.find(':') == std::string::npos ? host : "[" + host + "]";
    fmt::print("spherule serves {} ({} spheres) on {}\n  {}\n  {}\n  open http://{}:{}/\n", live.scene, live.spheres,
               live.renderer, live.reason, "stop with Ctrl-C", shown, runtime.port());
    std::fflush(stdout);
    spdlog::debug("asked for scene {}, device {}", options.scene.scene, options.scene.device);
}

int serve(const ServeOptions& options) {
    const auto endpoint = endpointOf(options.listen);
    if (!endpoint) return report(endpoint.error());
    const Result<quality::Table> table =
        options.table.empty() ? quality::ownTable() : quality::loadTable(options.table);
    if (!table) return report(table.error());
    const StopSignals signals;
    net::Options listen;
    listen.host = endpoint->host;
    listen.port = endpoint->port;
    auto runtime = Runtime::start(options.scene, *table, listen);
    if (!runtime) return report(runtime.error());
    announce(options, **runtime, *endpoint);
    while (!signals.wait())
        if (const auto failure = (*runtime)->failure()) {
            (*runtime)->drain();
            return report(*failure);
        }
    signals.release();
    spdlog::info("stopping; a second signal ends it at once");
    (*runtime)->drain();
    return exitDone;
}

}  // namespace

void addServe(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<ServeOptions>();
    CLI::App* command = app.add_subcommand("serve", "simulate and show it in a browser");
    options->scene.addTo(*command);
    command->add_option("--listen", options->listen, "host:port; port 0 takes a free one")->capture_default_str();
    command->add_option(
        "--quality-table", options->table,
        "a measure.json of `spherule measure`: what the dial says of errors and costs, in place of what "
        "came with the program");
    command->footer(exitCodesText);
    command->callback([options, &exitCode] { exitCode = serve(*options); });
}

}  // namespace spherule::app
