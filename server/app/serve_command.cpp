#include "app/exit_codes.h"
#include "app/options.h"
#include "app/serving.h"
#include "app/settings.h"
#include "app/sim_loop.h"

namespace spherule::app {

namespace {

struct ServeOptions {
    SceneOptions scene;
    TapeOptions recordings;
    ServingOptions serving;
    std::string table;
};

Result<std::unique_ptr<Show>> open(const ServeOptions& options, const quality::Table& table, const Stage& stage) {
    auto world = World::open(options.scene.device, options.scene.scene, options.scene.overrides);
    if (!world) return tl::unexpected(world.error());
    stage.live.update([&](LiveReport& report) {
        report.device = (*world)->device().info();
        report.scenes = scene::names();
        report.scene = (*world)->simulation().scene().name;
        report.spheres = (*world)->simulation().count();
    });
    return std::make_unique<SimLoop>(std::move(*world), stage, table, options.recordings);
}

int serve(const ServeOptions& options) {
    const Result<quality::Table> table =
        options.table.empty() ? quality::ownTable() : quality::loadTable(options.table);
    if (!table) return report(table.error());
    return serveUntilStopped([&](const Stage& stage) { return open(options, *table, stage); }, options.serving,
                             "serves");
}

}  // namespace

void addServe(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<ServeOptions>();
    CLI::App* command = app.add_subcommand("serve", "simulate and show it in a browser");
    options->scene.addTo(*command);
    options->serving.addTo(*command);
    addTape(*command, options->recordings);
    command->add_option(
        "--quality-table", options->table,
        "a measure.json of `spherule measure`, with errors and costs for the dial [a table in the program]");
    command->footer(exitCodesText);
    addSettings(*command);
    command->callback([options, &exitCode] { exitCode = serve(*options); });
}

}  // namespace spherule::app
