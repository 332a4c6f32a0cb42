#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "checkpoint/keeper.h"
#include "compute/device.h"
#include "core/progress.h"
#include "host/from_proto.h"
#include "host/step_scheduler.h"
#include "scene/load.h"
#include "sim/commands.h"
#include "sim/preparation.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

namespace spherule::host {

// A device, the simulation on it, and the pace of its steps. Used by the simulation thread.
class SimulationHost {
  public:
    using Clock = StepScheduler::Clock;

    // Goes on from a checkpoint of `keeper`, if it has one to go on from, and begins with the scene otherwise. `keeper`
    // may be null.
    static Result<std::unique_ptr<SimulationHost>> open(const std::string& deviceChoice, const std::string& scene,
                                                        const scene::Overrides& overrides,
                                                        checkpoint::Keeper* keeper = nullptr);

    // Commands. Each returns a result, or refuses and changes nothing. nullopt: a change is under way now, and
    // advanceChange() gives the result. change() and step() require that no change is under way. load() and a reset
    // replace a change under way.
    std::optional<Result<sim::Applied>> change(const sim::Command& command, std::optional<double> speed = {});
    std::optional<Result<sim::Applied>> load(MakeScene make);
    Result<void> step(std::uint32_t count);  // adds to the steps that are left
    void pause() { paused_ = true, pendingSteps_ = 0; }
    void resume();
    sim::Applied query();
    Result<sim::Applied> inspect(std::uint64_t sphere);
    // The result of a command that takes effect now.
    [[nodiscard]] sim::Applied applied() const { return {.step = simulation_->steps()}; }

    [[nodiscard]] bool changing() const { return change_.has_value(); }
    [[nodiscard]] Progress::Seen changeProgress() const { return change_->preparation->progress(); }
    // Does pieces of the change for about `slice`, or waits that long for the thread that builds. Returns the result of
    // the change once it is done.
    std::optional<Result<sim::Applied>> advanceChange(Clock::duration slice);
    void cancelChange() { change_.reset(); }

    // Returns true when steps are to be done as soon as they are due. Returns false while a change starts from the
    // present state.
    [[nodiscard]] bool running() const { return (!paused_ || pendingSteps_ > 0) && !heldStill(); }
    [[nodiscard]] bool paused() const { return paused_; }
    // Does substeps until `until` or the end of the step, at least one. Returns true at the end of the step.
    Result<bool> advance(Clock::time_point until);

    // Changes when the world or its spheres are replaced.
    [[nodiscard]] std::uint32_t epoch() const { return epoch_; }
    // Begins a new epoch if the simulation has replaced its spheres.
    void noticeGeneration();
    [[nodiscard]] v1::ServerMessage settings() const;

    [[nodiscard]] sim::Simulation& simulation() { return *simulation_; }
    [[nodiscard]] compute::Device& device() { return *device_; }
    [[nodiscard]] const scene::Overrides& overrides() const { return overrides_; }
    // The checkpoint from which open() went on; nullopt: it began with the scene. Its simulation has been moved out.
    [[nodiscard]] const std::optional<checkpoint::Keeper::Resumed>& resumed() const { return resumed_; }
    // The file or the name of the scene that open() was asked for.
    [[nodiscard]] const std::string& sceneAsked() const { return sceneAsked_; }
    // Returns the head of a checkpoint, without the fields that describe the state.
    [[nodiscard]] v1::StateHead stateHead() const;
    [[nodiscard]] StepScheduler& scheduler() { return scheduler_; }

  private:
    SimulationHost(std::unique_ptr<compute::Device> device, std::string sceneAsked, const scene::Overrides& overrides)
        : device_(std::move(device)), sceneAsked_(std::move(sceneAsked)), overrides_(overrides) {}

    // A change of the world that is under way.
    struct Change {
        enum class Kind : std::uint8_t { Load, Reset, Other };
        Kind kind = Kind::Other;
        std::unique_ptr<sim::Preparation> preparation;
        std::optional<double> speed{};  // set together with the change
    };
    sim::Applied finishChange();
    void adopt(std::unique_ptr<sim::Simulation> simulation);
    void beginEpoch();
    [[nodiscard]] bool heldStill() const {
        return change_ && change_->kind != Change::Kind::Load && !change_->preparation->letsStep();
    }

    std::unique_ptr<compute::Device> device_;
    std::string sceneAsked_;
    scene::Overrides overrides_;
    std::unique_ptr<sim::Simulation> simulation_;
    std::optional<checkpoint::Keeper::Resumed> resumed_;
    std::optional<Change> change_;
    StepScheduler scheduler_;
    bool paused_ = false;
    std::uint64_t script_ = 0;  // commands of the script of the run from which this world comes
    std::uint32_t pendingSteps_ = 0;
    std::uint32_t epoch_ = 0;
    std::uint32_t generation_ = 0;
};

}  // namespace spherule::host
