#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "checkpoint/keeper.h"
#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/progress_line.h"
#include "compute/device.h"
#include "core/log.h"
#include "host/replay.h"
#include "host/watchdog.h"
#include "sim/state.h"

namespace spherule::cli {

namespace {

struct ReplayOptions {
    std::string log;
    std::string device = "auto";
    double watchdog = 0;
    bool json = false;
};

void print(const ReplayOptions& options, host::Replay& replay) {
    sim::Simulation& simulation = replay.simulation();
    const host::Replay::Counts& counts = replay.counts();
    const std::string hash = fmt::format("{:016x}", sim::hashOf(simulation.snapshot()));
    const auto& mismatch = replay.firstMismatch();
    if (options.json) {
        nlohmann::ordered_json report{{"scene", simulation.scene().name}, {"step", simulation.steps()},
                                      {"time", simulation.time()},        {"steps", counts.steps},
                                      {"commands", counts.commands},      {"decisions", counts.decisions},
                                      {"hashes", counts.hashes},          {"same", !mismatch},
                                      {"complete", replay.complete()},    {"stateHash", hash}};
        if (mismatch) report["firstDifference"] = mismatch->step;
        fmt::print("{}\n", report.dump());
        return;
    }
    fmt::print("{}: {} steps, {} commands, {} decisions of the goal for quality\n", simulation.scene().name,
               counts.steps, counts.commands, counts.decisions);
    if (!mismatch)
        fmt::print("{}; at the end, step {}, the state has the hash {}\n",
                   counts.hashes > 0 ? fmt::format("all {} hashes in the log are equal", counts.hashes)
                                     : "the log has no hashes to compare",
                   simulation.steps(), hash);
}

// Returns the exit code.
Result<int> replay(const ReplayOptions& options) {
    Interrupt interrupt;
    host::Watchdog watchdog{host::Watchdog::Seconds(options.watchdog)};
    watchdog.start([](const Error& error) { host::endNow(printError(error)); });
    auto device = compute::openDevice(options.device);
    if (!device) return tl::unexpected(device.error());
    spdlog::info("on {}: {}", (*device)->info().renderer, (*device)->info().reason);
    auto made = host::Replay::open(options.log, **device);
    if (!made) return tl::unexpected(made.error());
    host::Replay& replay = **made;
    if (!checkpoint::givesSameBits(replay.head(), (*device)->info()) || replay.program() != SPHERULE_VERSION)
        spdlog::warn("{} was written by spherule {} on {}; this is {} on {}: results may differ in their last bits",
                     options.log, replay.program(), replay.head().device(), SPHERULE_VERSION, (*device)->info().kind);
    ProgressLine progress;
    for (;;) {
        const auto more = replay.step();
        if (!more) {
            // The simulation is whole if the log is at fault.
            if (options.json && more.error().kind == ErrorKind::Input) print(options, replay);
            spdlog::warn("{} was carried out up to step {}: {} commands, {} hashes are equal", options.log,
                         replay.simulation().steps(), replay.counts().commands, replay.counts().hashes);
            return tl::unexpected(more.error());
        }
        if (!*more || replay.firstMismatch()) break;
        progress.show([&] {
            return fmt::format("step {}, {:.2f} s simulated ", replay.simulation().steps(), replay.simulation().time());
        });
    }
    print(options, replay);
    if (const auto& mismatch = replay.firstMismatch()) {
        const auto before = replay.lastMatch();
        printLine(
            fmt::format("the state of step {} has the hash {:016x}, in the log it is {:016x}; {}", mismatch->step,
                        mismatch->found, mismatch->logged,
                        before ? fmt::format("at step {} they were equal", *before) : "no hash before it was equal"));
        return exitDiffers;
    }
    if (!replay.complete())
        spdlog::warn("{} has no end: the program that wrote it was killed, or still runs", options.log);
    return exitDone;
}

}  // namespace

void addReplay(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command = app.add_subcommand("replay", "carry out a command log again, and compare its hashes");
    command->add_option("log", options->log, "the file of --log, or a recording of --record-log")->required();
    command->add_option("--device", options->device, "auto, gpu, gpu:N, gpu:cuda:N, cpu, cpu:THREADS or software")
        ->capture_default_str();
    addWatchdog(*command, options->watchdog);
    command->add_flag("--json", options->json, "print JSON");
    command->footer(exitCodesText);
    command->callback([options, &exitCode] {
        const auto done = replay(*options);
        exitCode = done ? *done : printError(done.error());
    });
}

}  // namespace spherule::cli
