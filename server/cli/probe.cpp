#include <fmt/format.h>

#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/options.h"
#include "compute/probe.h"

namespace spherule::cli {

namespace {

struct ProbeOptions {
    std::string device = "auto";
    bool json = false;
};

int probe(const ProbeOptions& options) {
    const auto found = compute::probe(options.device);
    if (!found) return printError(found.error());
    fmt::print("{}\n", options.json ? compute::probeJson(*found) : compute::probeText(*found));
    return found->chosen ? exitDone : exitNoDevice;
}

}  // namespace

void addProbe(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<ProbeOptions>();
    CLI::App* command =
        app.add_subcommand("probe", "show the devices to compute on, with a remedy for each missing part");
    command->add_option("--device", options->device, "auto, gpu, gpu:N, gpu:cuda:N, cpu, cpu:THREADS or software")
        ->capture_default_str();
    command->add_flag("--json", options->json, "print one line of JSON");
    command->footer(exitCodesText);
    command->callback([options, &exitCode] { exitCode = probe(*options); });
}

}  // namespace spherule::cli
