#include "cli/checkpoint_options.h"

#include <fmt/format.h>

#include "cli/option_values.h"

namespace spherule::cli {

void addCheckpoints(CLI::App& command, checkpoint::Options& options) {
    command.add_option("--checkpoints", options.folder, "write checkpoints to this folder; empty: none");
    command
        .add_option_function<std::string>(
            "--checkpoint-every",
            [&options](const std::string& text) {
                const auto seconds = secondsOf(text, "--checkpoint-every");
                if (!seconds) throw CLI::ValidationError(seconds.error().text());
                if (!(*seconds >= 0.1 && *seconds <= 1e7))
                    throw CLI::ValidationError("--checkpoint-every", fmt::format("is {}, must be 0.1s to 1e7s", text));
                options.every = std::chrono::duration<double>(*seconds);
            },
            "time between two checkpoints, such as 90s")
        ->default_str("60s");
    command.add_option("--keep-checkpoints", options.keep, "checkpoints that are kept: the newest")
        ->capture_default_str()
        ->check(CLI::Range(1U, 1'000'000U));
    command.add_flag("--resume", options.resume,
                     "go on from the newest checkpoint in the folder; without one, begin with the scene");
    command.add_option("--log", options.log, "write all commands to this file, for spherule replay; empty: no file");
    command
        .add_option("--hash-every", options.hashEvery,
                    "steps between two hashes of the state in that file; 0: only the first and the last")
        ->capture_default_str();
}

}  // namespace spherule::cli
