#pragma once

#include <memory>

#include "compute/device.h"
#include "measure/figure.h"
#include "sim/simulation.h"

namespace spherule::measure {

// Where a case runs: opens its simulations at a rung, takes their time and collects its figures.
class Bench {
  public:
    Bench(compute::Device& device, Rung rung, bool quick) : device_(device), quick_(quick) { outcome_.rung = rung; }

    // The last simulation opened is the one whose substeps, spheres and cost are reported.
    Result<std::unique_ptr<sim::Simulation>> open(scene::Scene scene);
    // The same in steps of one substep, to see what happens within a contact.
    Result<std::unique_ptr<sim::Simulation>> openBySubstep(scene::Scene scene);
    // The same with the substeps that the scene says.
    Result<std::unique_ptr<sim::Simulation>> openAsIs(scene::Scene scene);

    Result<void> step(sim::Simulation& simulation);
    Result<void> run(sim::Simulation& simulation, double seconds);
    void startClock();  // what ran before does not count

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

// Device seconds since the last call, except statistics and packing.
double takeSubstepSeconds(compute::Device& device);

}  // namespace spherule::measure
