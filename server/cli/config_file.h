#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace spherule::cli {

// Lets each option of the command also be set by an environment variable, and in the command's section of the file of
// --config. The variable of --max-sessions is SPHERULE_MAX_SESSIONS. The command line takes precedence over the
// environment, and the environment over the file. Call after all options have been added.
void addSettings(CLI::App& command);

// Adds --config for the whole program. An unknown setting in the file is an error.
void addConfig(CLI::App& app);

// The settings of the chosen command in the form of --config, each with its description.
std::string settingsText(const CLI::App& app);

}  // namespace spherule::cli
