#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/pacer.h"
#include "compute/device.h"
#include "scene/load.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

namespace spherule::app {

// A device, the simulation on it, and how it is paced: all that commands change. Used by the simulation thread.
class World {
  public:
    static Result<std::unique_ptr<World>> open(const std::string& deviceChoice, const std::string& scene,
                                               const scene::Overrides& overrides);

    // Carries a command out, or refuses it and changes nothing.
    Result<v1::Applied> apply(const v1::Command& command);

    [[nodiscard]] bool running() const { return !paused_ || pendingSteps_ > 0; }
    [[nodiscard]] bool paused() const { return paused_; }
    void pause() { paused_ = true, pendingSteps_ = 0; }
    Result<void> step();

    // Changes whenever the static facts do.
    [[nodiscard]] std::uint32_t epoch() const { return epoch_; }
    [[nodiscard]] v1::ServerMessage facts() const;
    [[nodiscard]] v1::ServerMessage settings() const;

    [[nodiscard]] sim::Simulation& simulation() { return *simulation_; }
    [[nodiscard]] compute::Device& device() { return *device_; }
    [[nodiscard]] Pacer& pacer() { return pacer_; }

  private:
    World(std::unique_ptr<compute::Device> device, const scene::Overrides& overrides)
        : device_(std::move(device)), overrides_(overrides) {}

    Result<v1::Applied> applied() const;
    Result<v1::Applied> load(const v1::LoadScene& load);
    Result<v1::Applied> stepBy(std::uint32_t count);
    Result<void> adopt(scene::Scene scene);
    void refreshFacts();

    std::unique_ptr<compute::Device> device_;
    scene::Overrides overrides_;
    std::unique_ptr<sim::Simulation> simulation_;
    Pacer pacer_;
    bool paused_ = false;
    std::uint32_t pendingSteps_ = 0;
    std::uint32_t epoch_ = 0;
    std::uint32_t generation_ = 0;
};

}  // namespace spherule::app
