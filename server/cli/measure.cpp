#include <chrono>

#include <fmt/format.h>

#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/options.h"
#include "compute/device.h"
#include "core/log.h"
#include "measure/report.h"

namespace spherule::cli {

namespace {

struct MeasureOptions {
    measure::Options what;
    std::string device = "auto";
    std::string out;
};

std::string commandOf(const MeasureOptions& options) {
    return fmt::format("spherule measure --suite {}{} --device {} --out {}", options.what.suite,
                       options.what.quick ? " --quick" : "", options.device, options.out);
}

Result<void> run(const MeasureOptions& options) {
    if (options.out == "-") return fail(ErrorKind::Input, "--out", "cannot be standard output: it is a folder");
    if (auto writable = measure::checkFolder(options.out); !writable) return writable;
    auto device = compute::openDevice(options.device);
    if (!device) return tl::unexpected(device.error());
    spdlog::info("on {}: {}", (*device)->info().renderer, (*device)->info().reason);
    const auto start = std::chrono::steady_clock::now();
    const auto progress = [&](const std::string& what) {
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
        fmt::print(stderr, "{:7.1f} s  {}\n", passed.count(), what);
    };
    auto report = measure::measure(**device, options.what, progress);
    if (!report) return tl::unexpected(report.error());
    report->command = commandOf(options);
    if (auto done = measure::write(*report, options.out); !done) return done;
    progress("done; see " + options.out + "/measure.md");
    return {};
}

}  // namespace

void addMeasure(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<MeasureOptions>();
    CLI::App* command =
        app.add_subcommand("measure", "measure accuracy, cost and stability of every model on this machine");
    command->add_option("--suite", options->what.suite, "the suite to run")
        ->check(CLI::IsMember({"accuracy", "cost", "stability", "all"}))
        ->capture_default_str();
    command->add_flag("--quick", options->what.quick, "fewer and smaller cases: under a minute on two processors");
    command->add_option("--device", options->device, "auto, gpu, gpu:N, gpu:cuda:N, cpu, cpu:THREADS or software")
        ->capture_default_str();
    command->add_option("--out", options->out, "folder for measure.csv, measure.md, measure.json and the plots")
        ->required();
    command->footer(exitCodesText);
    command->callback([options, &exitCode] {
        const auto done = run(*options);
        exitCode = done ? exitDone : printError(done.error());
    });
}

}  // namespace spherule::cli
