#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace spherule::app {

// Beside the command line, each option of the command may be given as an environment variable, SPHERULE_MAX_SESSIONS
// for
// --max-sessions, and in the file of --config, in the command's section. The command line goes before the environment,
// and that before the file. Call when all options are there.
void addSettings(CLI::App& command);

// --config, for the whole program. A setting of the file that does not exist is an error.
void addConfig(CLI::App& app);

// The settings of the chosen command as --config takes them, with what each is for.
std::string settingsText(const CLI::App& app);

}  // namespace spherule::app
