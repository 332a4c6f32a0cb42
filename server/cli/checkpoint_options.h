#pragma once

#include <CLI/CLI.hpp>

#include "checkpoint/options.h"

namespace spherule::cli {

// Adds the options for checkpoints and the command log. `hashEvery`: the default of --hash-every (steps).
void addCheckpoints(CLI::App& command, checkpoint::Options& options, std::uint64_t hashEvery);

}  // namespace spherule::cli
