#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "core/result.h"

// Prints the errors of the program as "spherule: WHERE: WHAT". If WHERE is an option, or the environment variable that
// set it, the message also names the help of the command.
namespace spherule::cli {

// For a command line that could not be parsed.
std::string usageText(CLI::App& app, const CLI::ParseError& error);

// Stores the command, and the options that the environment set. Call after the command line has been parsed.
void rememberUsage(const CLI::App& app);
// For an error that a command found later. It is an error of usage only if its place is an option.
std::string usageText(const Error& error);

// Writes one line to stderr if it is accepted within a second. A pipe without a reader must not keep the program from
// ending.
void printLine(const std::string& what);
// Prints the error to stderr and returns its exit code.
int printError(const Error& error);

}  // namespace spherule::cli
