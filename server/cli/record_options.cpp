#include "cli/record_options.h"

namespace spherule::cli {

namespace {

void addCommon(CLI::App& command, recording::Options& options, CLI::Option* needed) {
    CLI::Option* const tier =
        command
            .add_option_function<std::string>(
                "--record-tier",
                [&options](const std::string& name) {
                    options.tier = name == "eco" ? v1::ECO : name == "normal" ? v1::NORMAL : v1::FINE;
                },
                "precision of positions: fine, normal or eco, 1/500, 1/50 or 1/16 of the smallest radius [fine]")
            ->check(CLI::IsMember({"fine", "normal", "eco"}));
    CLI::Option* const log =
        command.add_flag("--record-log", options.log, "recordings carry a command log, for spherule replay");
    if (needed == nullptr) return;
    tier->needs(needed);
    log->needs(needed);
}

CLI::Option* addFile(CLI::App& command, recording::Options& options) {
    return command.add_option("--record", options.path, "record in this file");
}

}  // namespace

void addRunRecording(CLI::App& command, recording::Options& options) {
    CLI::Option* const file = addFile(command, options);
    addCommon(command, options, file);
    command.add_flag("--force", options.replace,
                     "replace existing files of --record, --dump, --surface-forces and --log");
    command.add_option("--record-rate", options.rate, "frames per simulated second, at most one a step")
        ->capture_default_str()
        ->check(CLI::Range(0.001, 1e6))
        ->needs(file);
}

void addLiveRecording(CLI::App& command, recording::LiveOptions& options) {
    addFile(command, options);
    addCommon(command, options, nullptr);
    command.add_flag("--force", options.replace, "replace existing files of --record and --log");
    command.add_option("--record-rate", options.rate, "frames per second of recordings: 5, 10, 20, 30 or 60")
        ->capture_default_str()
        ->check(CLI::IsMember({5.0, 10.0, 20.0, 30.0, 60.0}));
    command
        .add_option("--recordings", options.folder,
                    "folder for recordings that controllers start; empty: none can be started")
        ->capture_default_str();
    command
        .add_option("--recordings-limit", options.folderBytes,
                    "largest size of all recordings in that folder, such as 4GiB [4GiB]")
        ->transform(CLI::AsSizeValue(false));
}

}  // namespace spherule::cli
