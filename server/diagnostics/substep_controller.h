#pragma once

#include <optional>
#include <string>

#include "diagnostics/auto_quality.h"
#include "sim/simulation.h"

namespace spherule::diagnostics {

// Moves the substeps of a running scene to hold its goal, if it has one.
class SubstepController {
  public:
    // Call after each step. Returns a message when the substeps have changed or cannot hold the goal.
    Result<std::optional<std::string>> stepped(sim::Simulation& simulation, double wallMs);
    // Call when the scene, its goal or anything else that affects its substeps has changed.
    void reset() { *this = {}; }
    template <class Archive>
    void archive(Archive& a) {
        a(quality_, steps_, ms_, raised_);
    }

  private:
    [[nodiscard]] bool full(const scene::Scene& scene) const;

    std::optional<AutoQuality> quality_;
    int steps_ = 0;        // since the last reading
    double ms_ = 0;        // wall time of these steps (ms)
    bool raised_ = false;  // fast motion raised the substeps in one of these steps
};

}  // namespace spherule::diagnostics
