#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quality/dial.h"
#include "quality/energy_watch.h"
#include "quality/overlap_watch.h"
#include "sim/simulation.h"

namespace spherule::app {

// What those who watch a running world are told of it: its figures, and what the dial's positions cost in it.
class Observer {
  public:
    explicit Observer(quality::Table table) : table_(std::move(table)) {}

    void stepped(double wallMs);
    // Nobody looks: what was stepped does not count.
    void rest() {
        steps_ = 0;
        ms_ = 0;
    }
    // Something besides the steps has changed the world: energies before and after cannot be compared.
    void disturbed() { energy_.disturbed(); }
    // The spheres or what else substeps depend on may be others; says whether the dial is.
    bool refresh(const sim::Simulation& simulation, std::uint32_t epoch);

    struct Sight {
        v1::Diagnostics diagnostics;
        std::vector<std::string> alarms;
        bool dialMoved = false;  // it costs something else than it last said
    };
    // Measures. Device seconds per pass are those since the last time.
    Sight look(sim::Simulation& simulation, const std::vector<double>& passSeconds);

    // As it was last said to have changed.
    [[nodiscard]] v1::Dial dial() const { return ratio_ > 0 ? quality::calibrated(dial_, ratio_) : dial_; }

  private:
    bool calibrate(const sim::Simulation& simulation, double stepMs);

    quality::Table table_;
    quality::EnergyWatch energy_;
    quality::OverlapWatch overlap_;
    sim::Impacts impacts_;  // that have been told
    v1::Dial dial_;         // not calibrated
    std::string basis_;     // what it follows from
    std::uint32_t epoch_ = 0;
    double ratio_ = 0;  // of a step's time to the estimate; 0: unknown
    std::uint32_t substeps_ = 0;
    std::uint64_t steps_ = 0;  // since the last look
    double ms_ = 0;
};

}  // namespace spherule::app
