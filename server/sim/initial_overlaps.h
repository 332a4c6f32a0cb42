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

// Returns the largest overlap, in radii, that the scene's model resolves without adding kinetic energy. For `accurate`
// it is the overlap of the fastest impact to expect: a deeper spring holds more energy than any impact in the scene.
double maxSafeOverlap(const scene::Scene& scene);

// Pushes spheres apart by moving them, within the walls and without gravity or friction. Ends when no overlap is larger
// than `maxOverlap` (a fraction of the smaller radius), or after many sweeps. No simulated time passes. Needs memory
// for a simulation of its own. Used by the thread that owns the device.
class InitialOverlapResolver {
  public:
    InitialOverlapResolver(compute::Device& device, const scene::Scene& scene, const State& state, double maxOverlap);
    ~InitialOverlapResolver();
    InitialOverlapResolver(const InitialOverlapResolver&) = delete;
    InitialOverlapResolver& operator=(const InitialOverlapResolver&) = delete;

    // Does one sweep, or one piece of the preparation. Returns true once it has ended. Do not call it again
    // after that or after an error.
    Result<bool> advance();

    [[nodiscard]] double share() const;  // sweeps done, as a share of the sweeps allowed
    [[nodiscard]] std::uint32_t sweeps() const { return sweeps_; }
    // Returns the largest overlap at the last check, as a fraction of the smaller radius.
    [[nodiscard]] double overlap() const { return overlap_; }
    [[nodiscard]] State takeState();  // at rest

  private:
    double maxOverlap_;
    std::unique_ptr<Preparation> preparation_;  // of simulation_, until that exists
    std::unique_ptr<Simulation> simulation_;
    std::uint32_t sweeps_ = 0;
    bool measured_ = false;  // overlaps were measured since the last sweep
    double overlap_ = 0;
};

}  // namespace spherule::sim
