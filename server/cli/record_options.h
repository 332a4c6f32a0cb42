#pragma once

#include <CLI/CLI.hpp>

#include "recording/options.h"

namespace spherule::cli {

// For `run`. The rate is in frames per simulated second, at most one frame a step.
void addRunRecording(CLI::App& command, recording::Options& options);
// For `serve`. The rate is in frames per second, as viewers get them.
void addLiveRecording(CLI::App& command, recording::LiveOptions& options);

}  // namespace spherule::cli
