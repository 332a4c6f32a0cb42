#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

#include "cli/config_file.h"
#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/option_values.h"
#include "cli/options.h"
#include "cli/server_options.h"
#include "client/fetch.h"

namespace spherule::cli {

namespace {

constexpr std::chrono::seconds timeout{5};

struct HealthOptions {
    std::string listen;
    std::string certificateFile;
};

// A server that listens on all addresses is asked on the loopback address.
std::string reachable(const std::string& host) {
    if (host == "0.0.0.0") return "127.0.0.1";
    return host == "::" ? "::1" : host;
}

int health(const HealthOptions& options) {
    const auto endpoint = endpointOf(options.listen);
    if (!endpoint) return printError(endpoint.error());
    const auto answer = client::fetch({.secure = !options.certificateFile.empty(),
                                       .host = reachable(endpoint->host),
                                       .port = std::to_string(endpoint->port),
                                       .path = "/readyz"},
                                      timeout);
    if (!answer) return printError(answer.error());
    fmt::print("{}", answer->body);
    return answer->status == 200 ? exitDone : exitRefused;
}

}  // namespace

void addHealth(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<HealthOptions>();
    CLI::App* command = app.add_subcommand("health", "ask a server on this machine for /readyz");
    addListen(*command, options->listen);
    command->add_option("--tls-certificate", options->certificateFile, "the server's certificate, if it speaks TLS");
    command->footer(exitCodesText);
    addSettings(*command);
    command->callback([options, &exitCode] { exitCode = health(*options); });
}

}  // namespace spherule::cli
