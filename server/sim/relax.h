#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec4.hpp>

#include "compute/device.h"
#include "core/result.h"
#include "scene/scene.h"
#include "sim/state.h"

namespace spherule::sim {

class Preparation;
class Simulation;

// The deepest overlap, in radii, up to which the scene's model makes no speed of pushing spheres apart. For the springs
// of `accurate` it is that of the fastest impact to expect: deeper ones hold more energy than anything in the scene.
double deepestBearable(const scene::Scene& scene);

// Pushes spheres apart by position alone, without gravity or friction and within the walls, until no overlap is larger
// than `most` (in smaller radii) or many sweeps have passed. No time passes. Needs memory for a simulation of its own.
// Used by the thread that owns the device.
class Relaxation {
  public:
    Relaxation(compute::Device& device, const scene::Scene& scene, const State& state, double most);
    ~Relaxation();
    Relaxation(const Relaxation&) = delete;
    Relaxation& operator=(const Relaxation&) = delete;

    // One sweep, or one piece of the preparation for them. True once it is over: call it no more then, nor after an
    // error.
    Result<bool> advance();

    [[nodiscard]] double share() const;  // of the sweeps that are allowed
    [[nodiscard]] std::uint32_t sweeps() const { return sweeps_; }
    [[nodiscard]] double overlap() const { return overlap_; }  // the largest when it last looked, in smaller radii
    [[nodiscard]] std::vector<glm::vec4> takePositions();      // m, relative to the bounds' centre; w = radius

  private:
    double most_;
    std::unique_ptr<Preparation> preparation_;  // of the world, until that is there
    std::unique_ptr<Simulation> world_;
    std::uint32_t sweeps_ = 0;
    bool looked_ = false;  // since the last sweep
    double overlap_ = 0;
};

}  // namespace spherule::sim
