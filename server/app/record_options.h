#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include "spherule/v1/frame.pb.h"

namespace spherule::app {

// Options of a recording.
struct RecordOptions {
    std::string path;  // empty: no recording from the beginning on
    v1::Tier tier = v1::FINE;
    double rate = 30;      // frames per second
    bool replace = false;  // replace an existing file; in `run`, also the file of --dump
};

// Options of recordings while viewers watch.
struct TapeOptions : RecordOptions {
    std::string folder = "recordings";                    // for recordings that controllers start
    std::uint64_t folderBytes = std::uint64_t{4} << 30U;  // limit for all recordings in that folder
};

// For `run`. The rate is in frames per simulated second, at most one frame a step.
void addRecord(CLI::App& command, RecordOptions& options);
// For `serve`. The rate is in frames per second, as viewers get them.
void addTape(CLI::App& command, TapeOptions& options);

}  // namespace spherule::app
