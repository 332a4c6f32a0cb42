#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "compute/device.h"
#include "sim/layout.h"
#include "sim/simulation.h"

namespace spherule::bench {

// One way to do a substep, with its own arrays on the device.
class Method {
  public:
    virtual ~Method() = default;
    virtual void upload(const sim::State& state) = 0;
    virtual void substep() = 0;
    // Substeps that belong together because their work differs, as when lists are kept for some of them.
    [[nodiscard]] virtual unsigned period() const { return 1; }
    // What there is to say about the substeps since the upload; may be empty. Waits for the device.
    virtual std::string note() = 0;
};

// What the baselines are made for: equal spheres between walls.
struct Setting {
    compute::Device& device;
    sim::layout::Parameters parameters;  // the kernels' uniform block, but for the cells
    bool count = false;                  // tally contacts, which costs time
};
Setting settingFor(compute::Device& device, sim::Simulation& simulation, bool count = false);

}  // namespace spherule::bench
