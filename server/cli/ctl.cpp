#include <fmt/format.h>

#include <chrono>

#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/options.h"
#include "cli/progress_line.h"
#include "cli/secret_files.h"
#include "client/command_parser.h"
#include "client/ctl.h"
#include "client/url.h"
#include "core/text.h"

namespace spherule::cli {

namespace {

struct CtlOptions {
    client::Target target;
    std::string tokenFile;
    std::string authoritiesFile;
    std::vector<std::string> words;
    unsigned timeoutSeconds = 30;
};

bool isLocal(const std::string& url) {
    const auto parts = client::parseUrl(url);
    return parts && (parts->host == "localhost" || parts->host == "::1" || parts->host.starts_with("127."));
}

// Adds the names of the scenes to an error about a scene file: the word may have been meant as a name.
Error withScenes(Error error, const std::vector<std::string>& words) {
    if (words.size() == 2 && words[0] == "load" && error.where == words[1])
        error.message += fmt::format(" (one of {})", fmt::join(scene::names(), ", "));
    return error;
}

int ctl(const CtlOptions& options) {
    const auto command = client::commandFrom(options.words);
    if (!command) return printError(withScenes(command.error(), options.words));
    client::Target target = options.target;
    target.timeout = std::chrono::seconds(options.timeoutSeconds);
    auto token = tokenOf("--token-file", options.tokenFile, "SPHERULE_TOKEN");
    if (!token) return printError(token.error());
    target.token = std::move(*token);
    if (!target.token.empty() && target.url.starts_with("ws://") && !isLocal(target.url))
        fmt::print(stderr, "the token goes to {} unencrypted: use wss:// on networks of other people\n", target.url);
    auto authorities = contentOf("--ca", options.authoritiesFile);
    if (!authorities) return printError(authorities.error());
    target.authorities = std::move(*authorities);
    const auto asks = [](const v1::Person& holder) {
        fmt::print(stderr, "{} (session {}) has control; asking for it\n", withoutControls(holder.client()),
                   holder.session());
    };
    Result<v1::CommandResult> result;
    {
        ProgressLine progress;
        result = client::sendCommand(target, *command, asks, [&progress](const v1::Change& change) {
            progress.show([&] {
                return fmt::format("{}: {}, {:.0f} %   ", withoutControls(change.what()),
                                   withoutControls(change.doing()), 100 * change.share());
            });
        });
    }
    if (!result) return printError(result.error());
    fmt::print(result->has_applied() ? stdout : stderr, "{}\n", client::resultText(*result));
    return result->has_applied() ? exitDone : exitRefused;
}

}  // namespace

void addCtl(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<CtlOptions>();
    CLI::App* command = app.add_subcommand("ctl", "send one command to a running server and print its answer");
    command->add_option("url", options->target.url, "such as ws://127.0.0.1:8080/ws, or wss:// for TLS")->required();
    command->add_option("command", options->words, "words, such as: set gravity 0 0 -1.6; or a JSON object")
        ->required();
    command->add_option("--token-file", options->tokenFile,
                        "file with the token; SPHERULE_TOKEN takes the token itself");
    command->add_option("--ca", options->authoritiesFile,
                        "file with certificate authorities (PEM) to trust, in place of the system's");
    command
        ->add_option("--timeout", options->timeoutSeconds,
                     "longest wait (s) for the answer, for progress, or for control")
        ->capture_default_str();
    // Numbers such as -1.6 are words of the command, not options.
    command->positionals_at_end();
    command->footer(fmt::format("Commands:\n{}\n\n{}", client::commandForms(), exitCodesText));
    command->callback([options, &exitCode] { exitCode = ctl(*options); });
}

}  // namespace spherule::cli
