#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "compute/device.h"
#include "sim/layout.h"
#include "sim/simulation.h"

namespace spherule::bench {

// An implementation of a substep, with its own arrays on the device.
class Method {
  public:
    virtual ~Method() = default;
    virtual void upload(const sim::State& state) = 0;
    virtual void substep() = 0;
    // Number of substeps to measure together because their work differs, for example when lists are kept between
    // rebuilds.
    [[nodiscard]] virtual unsigned period() const { return 1; }
    // A note on the substeps since the upload; may be empty. Waits for the device.
    virtual std::string note() = 0;
};

// The setting of a baseline: equal spheres between walls.
struct Setting {
    compute::Device& device;
    sim::layout::Parameters parameters;  // the kernels' uniform block, except the fields of the cell grid
    bool count = false;                  // count contacts, which costs time
};
Setting settingFor(compute::Device& device, sim::Simulation& simulation, bool count = false);

}  // namespace spherule::bench
