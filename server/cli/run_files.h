#pragma once

#include "checkpoint/keeper.h"
#include "cli/script.h"
#include "compute/device.h"
#include "diagnostics/substep_controller.h"
#include "sim/simulation.h"

namespace spherule::cli {

// The checkpoints and the command log of `spherule run`. A checkpoint that cannot be written is a warning: the run goes
// on. All members must outlive it.
struct RunFiles {
    checkpoint::Keeper& keeper;
    const compute::Device& device;
    const Script& script;
    diagnostics::SubstepController& controller;

    // Returns the head of a checkpoint, without the fields that describe the state.
    [[nodiscard]] v1::StateHead head() const;
    // Call after each step: writes a checkpoint if one is due.
    void stepped(sim::Simulation& simulation) const;
    // Writes the ends of the logs, and the last checkpoint if the run has succeeded. Waits for the disk.
    void finish(sim::Simulation& simulation, const Result<void>& run) const;

  private:
    void report() const;
};

}  // namespace spherule::cli
