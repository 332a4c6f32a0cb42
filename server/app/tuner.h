#pragma once

#include <optional>
#include <string>

#include "quality/auto_quality.h"
#include "sim/simulation.h"

namespace spherule::app {

// Holds the goal of a running scene, if it has one, by its substeps.
class Tuner {
  public:
    // After each step; what has changed, or cannot be held.
    Result<std::optional<std::string>> stepped(sim::Simulation& simulation, double wallMs);
    // The scene, its goal or what else its substeps depend on is another now.
    void forget() { *this = {}; }

  private:
    [[nodiscard]] bool full(const scene::Scene& scene) const;

    std::optional<quality::AutoQuality> quality_;
    int steps_ = 0;  // since the last reading
    double ms_ = 0;
    bool raised_ = false;  // substeps, by fast motion in one of them
};

}  // namespace spherule::app
