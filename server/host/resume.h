#pragma once

#include <string>

#include "checkpoint/keeper.h"
#include "sim/simulation.h"

// `serve` and `run` go on from a checkpoint.
namespace spherule::host {

// Logs the checkpoint from which the program goes on. Warns if its scene is not `asked`, the file or the name of a
// scene on the command line.
void reportResumed(const std::string& checkpoint, const sim::Simulation& simulation, const std::string& asked);

// Ends the pulls of all sessions, which are gone, with an entry in the command log for each.
void releasePulls(sim::Simulation& simulation, checkpoint::Keeper& keeper);

}  // namespace spherule::host
