#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quality/dial.h"
#include "quality/energy_watch.h"
#include "quality/overlap_watch.h"
#include "sim/simulation.h"

namespace spherule::app {

// Measures a running world for viewers: its figures, and the costs in the dial.
class Observer {
  public:
    explicit Observer(quality::Table table) : table_(std::move(table)) {}

    void stepped(double wallMs);
    // Discards the measured steps. Call while nobody watches.
    void rest() {
        steps_ = 0;
        ms_ = 0;
    }
    // Call when anything except a step has changed the world: energies before and after cannot be compared.
    void disturbed() { energy_.disturbed(); }
    // Rebuilds the dial if the spheres or a setting that affects it changed. Returns true if it did.
    bool refresh(const sim::Simulation& simulation, std::uint32_t epoch);

    struct Sight {
        v1::Diagnostics diagnostics;
        std::vector<std::string> alarms;
        bool dialMoved = false;  // the costs in the dial have changed
    };
    // Measures the world. `passSeconds`: device time per pass since the last call.
    Sight look(sim::Simulation& simulation, const std::vector<double>& passSeconds);

    // The dial, with the costs of the last look() that reported a change.
    [[nodiscard]] v1::Dial dial() const { return ratio_ > 0 ? quality::calibrated(dial_, ratio_) : dial_; }

  private:
    bool calibrate(const sim::Simulation& simulation, double stepMs);

    quality::Table table_;
    quality::EnergyWatch energy_;
    quality::OverlapWatch overlap_;
    sim::Impacts impacts_;  // reported so far
    v1::Dial dial_;         // not calibrated
    std::string basis_;     // epoch and settings from which dial_ was built
    std::uint32_t epoch_ = 0;
    double ratio_ = 0;  // measured time of a step over its estimate; 0: unknown
    std::uint32_t substeps_ = 0;
    std::uint64_t steps_ = 0;  // since the last look()
    double ms_ = 0;            // wall time of these steps (ms)
};

}  // namespace spherule::app
