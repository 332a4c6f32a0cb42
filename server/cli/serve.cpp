#include "cli/checkpoint_options.h"
#include "cli/config_file.h"
#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/options.h"
#include "cli/record_options.h"
#include "cli/serve_until_signal.h"
#include "host/simulation_producer.h"

namespace spherule::cli {

namespace {

struct ServeOptions {
    SceneOptions scene;
    recording::LiveOptions recordings;
    checkpoint::Options checkpoints;
    ServerOptions serving;
    std::string table;
    bool watch = false;
};

Result<std::unique_ptr<host::FrameProducer>> open(const ServeOptions& options, const diagnostics::Table& table,
                                                  const host::ProducerIo& io) {
    // It begins before the scene is read, so that no change is missed.
    std::unique_ptr<host::SceneWatch> watch;
    if (options.watch) watch = std::make_unique<host::SceneWatch>(options.scene.scene);
    auto keeper = checkpoint::Keeper::open(options.checkpoints);
    if (!keeper) return tl::unexpected(keeper.error());
    auto simulation =
        host::SimulationHost::open(options.scene.device, options.scene.scene, options.scene.overrides, keeper->get());
    if (!simulation) return tl::unexpected(simulation.error());
    io.board.update([&](host::ServerStatus& current) {
        current.device = (*simulation)->device().info();
        current.scenes = scene::names();
        current.catalog = scene::catalog(current.device.kind);
        current.scene = (*simulation)->simulation().scene().name;
        current.spheres = (*simulation)->simulation().count();
    });
    return std::make_unique<host::SimulationProducer>(std::move(*simulation), io, table, options.recordings,
                                                      std::move(watch), std::move(*keeper));
}

int serve(const ServeOptions& options) {
    const Result<diagnostics::Table> table =
        options.table.empty() ? diagnostics::ownTable() : diagnostics::loadTable(options.table);
    if (!table) return printError(table.error());
    if (options.watch && !scene::isPath(options.scene.scene))
        return printError({ErrorKind::Input, "--watch", "needs the file of a scene, such as mine.json"});
    if (options.recordings.replace && options.recordings.path.empty() && options.checkpoints.log.empty())
        return printError({ErrorKind::Input, "--force", "has nothing to replace; give --record or --log"});
    const std::string& log = options.checkpoints.log;
    if (log == "-") return printError({ErrorKind::Input, "--log", "cannot be standard output; give it a file"});
    if (!log.empty() && log == options.recordings.path)
        return printError({ErrorKind::Input, "--log", "is the file of --record; give each its own"});
    return serveUntilSignal([&](const host::ProducerIo& io) { return open(options, *table, io); }, options.serving,
                            "serves");
}

}  // namespace

void addServe(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<ServeOptions>();
    CLI::App* command = app.add_subcommand("serve", "simulate and show it in a browser");
    options->scene.addTo(*command);
    options->serving.addTo(*command);
    addLiveRecording(*command, options->recordings);
    addCheckpoints(*command, options->checkpoints);
    command->add_option(
        "--quality-table", options->table,
        "a measure.json of `spherule measure`, with errors and costs for the dial [a table in the program]");
    command->add_flag("--watch", options->watch,
                      "load the scene again when its file, or a file that it names, is saved");
    command->footer(exitCodesText);
    addSettings(*command);
    command->callback([options, &exitCode] {
        options->checkpoints.replace = options->recordings.replace;
        exitCode = serve(*options);
    });
}

}  // namespace spherule::cli
