#pragma once

#include <optional>
#include <string>

#include "server_watch.h"
#include "tally.h"

namespace spherule::load {

struct Outcome {
    Tallies tallies;
    double seconds = 0;     // duration of the measurement
    double cpuSeconds = 0;  // CPU time of the load client in that time
    std::optional<ServerUsage> server;
};

// Formats the tables of a report, as Markdown or padded text.
std::string reportOf(const Outcome& outcome, bool markdown);

}  // namespace spherule::load
