#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/result.h"
#include "scene/catalog.h"
#include "scene/load.h"

// Each of the functions `add...(app, exitCode)` adds a subcommand to the command line. When chosen, the subcommand runs
// and sets `exitCode`.
namespace spherule::cli {

// Options of the command line that choose a scene and change it.
struct SceneOptions {
    std::string scene{scene::defaultScene};
    std::string device = "auto";
    scene::Overrides overrides;

    void addTo(CLI::App& command);
};

void addServe(CLI::App& app, int& exitCode);
void addRun(CLI::App& app, int& exitCode);
void addPlay(CLI::App& app, int& exitCode);
void addReplay(CLI::App& app, int& exitCode);
void addCompare(CLI::App& app, int& exitCode);
void addExport(CLI::App& app, int& exitCode);
void addPlan(CLI::App& app, int& exitCode);
void addScene(CLI::App& app, int& exitCode);
void addCtl(CLI::App& app, int& exitCode);
void addHealth(CLI::App& app, int& exitCode);
void addProbe(CLI::App& app, int& exitCode);
void addMeasure(CLI::App& app, int& exitCode);

// Accepts a finite number of 0 or above. CLI11's own check accepts nan.
extern const CLI::Validator finiteRate;

// Adds --quality and --substeps.
void addQuality(CLI::App& command, scene::Overrides& overrides);

// Adds --watchdog: time without progress (s) after which a command ends with exitDeviceLost; 0: never.
void addWatchdog(CLI::App& command, double& seconds);

}  // namespace spherule::cli
