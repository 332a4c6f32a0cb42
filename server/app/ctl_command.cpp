#include <fmt/format.h>

#include <chrono>

#include "app/exit_codes.h"
#include "app/options.h"
#include "net/ctl.h"

namespace spherule::app {

namespace {

struct CtlOptions {
    std::string url;
    std::vector<std::string> words;
    unsigned timeoutSeconds = 30;
};

int ctl(const CtlOptions& options) {
    const auto command = net::commandFrom(options.words);
    if (!command) return report(command.error());
    const auto result = net::sendCommand(options.url, *command, std::chrono::seconds(options.timeoutSeconds));
    if (!result) return report(result.error());
    fmt::print("{}\n", net::resultText(*result));
    return result->has_applied() ? exitDone : exitRefused;
}

}  // namespace

void addCtl(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<CtlOptions>();
    CLI::App* command = app.add_subcommand("ctl", "send one command to a running server and print its answer");
    command->add_option("url", options->url, "such as ws://127.0.0.1:8080/ws")->required();
    command->add_option("command", options->words, "words, such as: set gravity 0 0 -1.6; or a JSON object")
        ->required();
    command->add_option("--timeout", options->timeoutSeconds, "s to wait for the answer")->capture_default_str();
    // Numbers such as -1.6 are words of the command, not options.
    command->positionals_at_end();
    command->footer(fmt::format("Commands:\n{}\n{}", net::commandForms, exitCodesText));
    command->callback([options, &exitCode] { exitCode = ctl(*options); });
}

}  // namespace spherule::app
