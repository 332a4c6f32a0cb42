#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include "spherule/v1/frame.pb.h"

namespace spherule::app {

// What is recorded of a run, and where.
struct RecordOptions {
    std::string path;  // empty: nothing is recorded from the beginning on
    v1::Tier tier = v1::FINE;
    double rate = 30;      // frames per second
    bool replace = false;  // a file that is there; in `run`, that of --dump, too
};

// What is recorded while viewers watch.
struct TapeOptions : RecordOptions {
    std::string folder = "recordings";                    // of those that viewers start
    std::uint64_t folderBytes = std::uint64_t{4} << 30U;  // that all recordings in it may have
};

// For `run`: the rate is that of frames per simulated second, at most one a step.
void addRecord(CLI::App& command, RecordOptions& options);
// For `serve`: frames per second as viewers get them.
void addTape(CLI::App& command, TapeOptions& options);

}  // namespace spherule::app
