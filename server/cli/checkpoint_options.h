#pragma once

#include <CLI/CLI.hpp>

#include "checkpoint/options.h"

namespace spherule::cli {

// Adds the options for checkpoints and the command log.
void addCheckpoints(CLI::App& command, checkpoint::Options& options);

}  // namespace spherule::cli
