#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "core/result.h"

// Errors of the command line, and of the environment variables that stand for options. All have one form:
// "spherule: WHERE: WHAT; see `spherule COMMAND --help`", where WHERE is the option or the variable.
namespace spherule::app {

// Of a command line that could not be parsed.
std::string usageText(CLI::App& app, const CLI::ParseError& error);

// Once the command line has been parsed: which command it is, and which options were given by the environment.
void rememberUsage(const CLI::App& app);
// Of an error that a command found later. Only one whose place is an option is an error of usage.
std::string usageText(const Error& error);

}  // namespace spherule::app
