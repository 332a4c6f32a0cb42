#pragma once

#include <cstdint>
#include <string>

#include "spherule/v1/frame.pb.h"

namespace spherule::recording {

// Options of a recording.
struct Options {
    std::string path;  // empty: no recording from the beginning on
    v1::Tier tier = v1::FINE;
    double rate = 30;      // frames per second; in `run`, per simulated second
    bool replace = false;  // replace an existing file; in `run`, also the file of --dump
    bool log = false;      // the recording carries a command log
};

// Options of recordings while viewers watch.
struct LiveOptions : Options {
    std::string folder = "recordings";                    // for recordings that controllers start
    std::uint64_t folderBytes = std::uint64_t{4} << 30U;  // limit for all recordings in that folder
};

}  // namespace spherule::recording
