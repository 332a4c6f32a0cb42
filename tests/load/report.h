#pragma once

#include <optional>
#include <string>

#include "server_watch.h"
#include "tally.h"

namespace spherule::load {

struct Outcome {
    Tallies tallies;
    double seconds = 0;     // measured
    double cpuSeconds = 0;  // of the load client, over the same
    std::optional<ServerUsage> server;
};

// Tables for people; as Markdown, or padded.
std::string reportOf(const Outcome& outcome, bool markdown);

}  // namespace spherule::load
