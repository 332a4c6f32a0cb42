#include <CLI/CLI.hpp>

#include "app/exit_codes.h"
#include "app/options.h"
#include "core/log.h"

int main(int argc, char** argv) {
    using namespace spherule::app;
    CLI::App app("Spherule simulates very many spheres and shows them live in a browser.", "spherule");
    app.set_version_flag("--version", SPHERULE_VERSION);
    app.require_subcommand(1);
    app.footer(exitCodesText);
    bool verbose = false;
    app.add_flag("-v,--verbose", verbose, "log more");
    app.parse_complete_callback([&verbose] { spherule::startLog(verbose); });

    int exitCode = exitDone;
    addServe(app, exitCode);
    addRun(app, exitCode);
    addPlan(app, exitCode);
    addCtl(app, exitCode);
    addProbe(app, exitCode);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exitDone : exitInput;
    }
    return exitCode;
}
