#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/pacer.h"
#include "compute/device.h"
#include "core/progress.h"
#include "scene/load.h"
#include "sim/preparation.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

namespace spherule::app {

// A device, the simulation on it, and how it is paced: all that commands change. Used by the simulation thread.
class World {
  public:
    using Clock = Pacer::Clock;

    static Result<std::unique_ptr<World>> open(const std::string& deviceChoice, const std::string& scene,
                                               const scene::Overrides& overrides);

    // Carries a command out, or refuses it and changes nothing. Nothing: a change is under way now, and advanceChange()
    // gives the result. While one is under way only pause, resume and query may be applied, and load and reset, which
    // take its place.
    std::optional<Result<v1::Applied>> apply(const v1::Command& command);

    [[nodiscard]] bool changing() const { return change_ != nullptr; }
    [[nodiscard]] Progress::Seen changeProgress() const { return change_->progress(); }
    // Does pieces of the change for about `slice`, or waits that long for the thread that builds. Its result, once it
    // has one.
    std::optional<Result<v1::Applied>> advanceChange(Clock::duration slice);
    void cancelChange() { change_.reset(); }

    // Whether steps are to be done, as soon as they are due. None are while a change begins from the present state.
    [[nodiscard]] bool running() const { return (!paused_ || pendingSteps_ > 0) && !heldStill(); }
    [[nodiscard]] bool paused() const { return paused_; }
    void pause() { paused_ = true, pendingSteps_ = 0; }
    // Substeps, at least one, until `until` or the end of the step: true then.
    Result<bool> advance(Clock::time_point until);

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

    [[nodiscard]] v1::Applied applied() const;
    std::optional<Result<v1::Applied>> load(const v1::LoadScene& load);
    std::optional<Result<v1::Applied>> simulate(const v1::Command& command);
    Result<v1::Applied> stepBy(std::uint32_t count);
    v1::Applied finishChange();
    void adopt(std::unique_ptr<sim::Preparation> preparation);
    void refreshFacts();
    [[nodiscard]] bool heldStill() const { return change_ != nullptr && changeKind_ != v1::Command::kLoad; }

    std::unique_ptr<compute::Device> device_;
    scene::Overrides overrides_;
    std::unique_ptr<sim::Simulation> simulation_;
    std::unique_ptr<sim::Preparation> change_;  // under way
    v1::Command::KindCase changeKind_{};        // of its command
    std::optional<double> changeSpeed_;         // that comes with it
    Pacer pacer_;
    bool paused_ = false;
    std::uint32_t pendingSteps_ = 0;
    std::uint32_t epoch_ = 0;
    std::uint32_t generation_ = 0;
};

}  // namespace spherule::app
