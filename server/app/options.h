#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/result.h"
#include "scene/load.h"

// One function per subcommand: adds it to the command line; when chosen, it runs and sets `exitCode`.
namespace spherule::app {

// A scene on the command line and what may be changed of it.
struct SceneOptions {
    std::string scene = "box";
    std::string device = "auto";
    scene::Overrides overrides;

    void addTo(CLI::App& command);
};

void addServe(CLI::App& app, int& exitCode);
void addRun(CLI::App& app, int& exitCode);
void addPlay(CLI::App& app, int& exitCode);
void addExport(CLI::App& app, int& exitCode);
void addPlan(CLI::App& app, int& exitCode);
void addCtl(CLI::App& app, int& exitCode);
void addHealth(CLI::App& app, int& exitCode);
void addProbe(CLI::App& app, int& exitCode);
void addMeasure(CLI::App& app, int& exitCode);

// A check for options: a number that is finite and not negative. CLI11's own takes nan for one.
extern const CLI::Validator finiteRate;

// --quality and --substeps.
void addQuality(CLI::App& command, scene::Overrides& overrides);

// --watchdog: s without progress, after which a command ends with exitDeviceLost; 0: never.
void addWatchdog(CLI::App& command, double& seconds);

// One line to stderr, if somebody takes it within a second: a pipe that nobody reads must not keep the program from its
// end.
void complain(const std::string& what);
// Prints the error to stderr and gives its exit code.
int report(const Error& error);

}  // namespace spherule::app
