#pragma once

#include <memory>

#include "compute/device.h"
#include "measure/figure.h"
#include "sim/simulation.h"

namespace spherule::measure {

// Runs a case at a rung: opens its simulations, measures their time and collects its figures.
class Bench {
  public:
    Bench(compute::Device& device, Rung rung, bool quick) : device_(device), quick_(quick) { outcome_.rung = rung; }

    // Opens a simulation with the substeps of the rung. The outcome has the substeps, spheres and cost of the
    // simulation that was opened last.
    Result<std::unique_ptr<sim::Simulation>> open(scene::Scene scene);
    // Same as open(), but each step is one substep, so that a case can follow a contact.
    Result<std::unique_ptr<sim::Simulation>> openBySubstep(scene::Scene scene);
    // Same as open(), with the substeps of the scene.
    Result<std::unique_ptr<sim::Simulation>> openAsIs(scene::Scene scene);

    Result<void> step(sim::Simulation& simulation);
    Result<void> run(sim::Simulation& simulation, double seconds);
    void startClock();  // discards the time measured before

    void add(Figure figure) { outcome_.figures.push_back(std::move(figure)); }
    Outcome finish();

    [[nodiscard]] scene::Model model() const { return outcome_.rung.model; }
    [[nodiscard]] bool accurate() const { return model() == scene::Model::Accurate; }
    [[nodiscard]] bool quick() const { return quick_; }
    [[nodiscard]] compute::Device& device() { return device_; }

  private:
    compute::Device& device_;
    bool quick_;
    Outcome outcome_;
    double simulated_ = 0;
};

// Returns the device time (s) since the last call, without statistics and packing.
double takeSubstepSeconds(compute::Device& device);

}  // namespace spherule::measure
