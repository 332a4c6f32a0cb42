#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace spherule::checkpoint {

struct Options {
    std::string folder;                       // of checkpoints; empty: none are written
    std::chrono::duration<double> every{60};  // between two checkpoints
    unsigned keep = 3;                        // checkpoints that are kept
    bool resume = false;                      // goes on from the newest checkpoint, if there is one
    std::string log;                          // file of the command log; empty: none is written
    std::uint64_t hashEvery = 60;  // steps between two hashes in the log; 0: only at the beginning and the end
    bool replace = false;          // an existing log may be replaced
};

}  // namespace spherule::checkpoint
