#include <fmt/format.h>
#include <google/protobuf/stubs/logging.h>
#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "cli/config_file.h"
#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/options.h"
#include "core/log.h"

namespace spherule::cli {

namespace {

int runCommand(int argc, char** argv) {
    CLI::App app("Spherule simulates very many spheres and shows them live in a browser.", "spherule");
    app.set_version_flag("--version", SPHERULE_VERSION);
    app.require_subcommand(1);
    app.footer(exitCodesText);
    bool verbose = false;
    app.add_flag("-v,--verbose", verbose, "log more");
    LogFormat format = LogFormat::Text;
    app.add_option_function<std::string>(
           "--log-format",
           [&format](const std::string& name) { format = name == "json" ? LogFormat::Json : LogFormat::Text; },
           "text, or json: one object a line [text]")
        ->check(CLI::IsMember({"text", "json"}))
        ->envname("SPHERULE_LOG_FORMAT");
    bool printConfig = false;
    app.add_flag("--print-config", printConfig, "print the settings of the command in the form of --config, and end")
        ->configurable(false);
    addConfig(app);
    app.parse_complete_callback([&] {
        startLog(verbose, format);
        rememberUsage(app);
        if (!printConfig) return;
        fmt::print("{}", settingsText(app));
        throw CLI::Success();
    });

    int exitCode = exitDone;
    addServe(app, exitCode);
    addRun(app, exitCode);
    addPlay(app, exitCode);
    addReplay(app, exitCode);
    addCompare(app, exitCode);
    addExport(app, exitCode);
    addPlan(app, exitCode);
    addScene(app, exitCode);
    addCtl(app, exitCode);
    addHealth(app, exitCode);
    addProbe(app, exitCode);
    addMeasure(app, exitCode);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        printLine(usageText(app, error));
        return exitInput;
    }
    return exitCode;
}

}  // namespace

}  // namespace spherule::cli

int main(int argc, char** argv) {
    // A write to a file at its size limit, or to a pipe without a reader, fails. It must not end the program.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    // Protobuf would log a line to stderr for each malformed message. The server refuses and counts these messages.
    google::protobuf::SetLogHandler(nullptr);
    try {
        return spherule::cli::runCommand(argc, argv);
    } catch (const std::bad_alloc&) {
        std::fputs("spherule: there is not enough memory for this; use fewer spheres, or give the program more\n",
                   stderr);
        return spherule::cli::exitRefused;
    } catch (const std::exception& error) {
        // Expected errors are returned as a Result.
        std::fprintf(stderr, "spherule: %s\n", error.what());
        return spherule::cli::exitFault;
    }
}
