#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnostics/dial.h"
#include "diagnostics/energy_watch.h"
#include "diagnostics/overlap_watch.h"
#include "sim/simulation.h"

namespace spherule::host {

// Measures a running world for viewers: its figures, and the costs in the dial.
class DiagnosticsSampler {
  public:
    explicit DiagnosticsSampler(diagnostics::Table table) : table_(std::move(table)) {}

    void addStep(double wallMs);
    // Discards the measured steps. Call while nobody watches.
    void discard() {
        steps_ = 0;
        ms_ = 0;
    }
    // Call when anything except a step has changed the world: energies before and after cannot be compared.
    void invalidateBaseline() { energy_.invalidateBaseline(); }
    // Rebuilds the dial if the spheres or a setting that affects it changed. Returns true if it did.
    bool updateDial(const sim::Simulation& simulation, std::uint32_t epoch);

    struct Sample {
        v1::Diagnostics diagnostics;
        std::vector<std::string> alarms;
        bool dialChanged = false;  // the costs in the dial have changed
    };
    // Measures the world. `passSeconds`: device time per pass since the last call.
    Sample sample(sim::Simulation& simulation, const std::vector<double>& passSeconds);

    // The dial, with the costs of the last sample() that reported a change.
    [[nodiscard]] v1::Dial dial() const { return ratio_ > 0 ? diagnostics::calibrated(dial_, ratio_) : dial_; }

  private:
    bool calibrate(const sim::Simulation& simulation, double stepMs);

    diagnostics::Table table_;
    diagnostics::EnergyWatch energy_;
    diagnostics::OverlapWatch overlap_;
    sim::Impacts impacts_;   // reported so far
    sim::ContactSums sums_;  // reported so far
    v1::Dial dial_;          // not calibrated
    std::string basis_;      // epoch and settings from which dial_ was built
    std::uint32_t epoch_ = 0;
    double ratio_ = 0;  // measured time of a step over its estimate; 0: unknown
    std::uint32_t substeps_ = 0;
    std::uint64_t steps_ = 0;  // since the last sample()
    double ms_ = 0;            // wall time of these steps (ms)
};

}  // namespace spherule::host
