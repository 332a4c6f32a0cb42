#include "host/simulation_host.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "host/to_proto.h"

namespace spherule::host {

namespace {

// Builds a scene and its spheres, on a thread that does not own the device.
sim::Preparation::Build builderOf(MakeScene make) {
    return [make = std::move(make)](Progress& progress) -> Result<sim::SceneAndState> {
        auto scene = make(progress);
        if (!scene) return tl::unexpected(scene.error());
        return sim::withInitialState(std::move(*scene));
    };
}

}  // namespace

Result<std::unique_ptr<SimulationHost>> SimulationHost::open(const std::string& deviceChoice, const std::string& scene,
                                                             const scene::Overrides& overrides,
                                                             checkpoint::Keeper* keeper) {
    auto device = compute::openDevice(deviceChoice);
    if (!device) return tl::unexpected(device.error());
    std::unique_ptr<SimulationHost> host(new SimulationHost(std::move(*device), scene, overrides));
    if (keeper != nullptr) {
        auto resumed = keeper->resume(*host->device_);
        if (!resumed) return tl::unexpected(resumed.error());
        host->resumed_ = std::move(*resumed);
    }
    if (auto& resumed = host->resumed_) {
        host->adopt(std::move(resumed->simulation));
        if (checkSpeed(resumed->head.speed())) host->scheduler_.setSpeed(resumed->head.speed());
        host->paused_ = resumed->head.paused();
        host->script_ = resumed->head.script();
        return host;
    }
    const std::string kind = host->device_->info().kind;
    auto preparation = std::make_unique<sim::Preparation>(
        *host->device_, builderOf([=](Progress& progress) { return scene::load(scene, kind, overrides, &progress); }));
    if (auto done = preparation->finish(); !done) return tl::unexpected(done.error());
    host->adopt(sim::Simulation::from(std::move(preparation)));
    return host;
}

v1::StateHead SimulationHost::stateHead() const {
    v1::StateHead head;
    head.set_device(device_->info().kind);
    head.set_renderer(device_->info().renderer);
    head.set_speed(scheduler_.speed());
    head.set_paused(paused_);
    head.set_script(script_);
    return head;
}

void SimulationHost::adopt(std::unique_ptr<sim::Simulation> simulation) {
    simulation_ = std::move(simulation);
    scheduler_.setStep(simulation_->scene().step);
    scheduler_.resume(Clock::now());
    pendingSteps_ = 0;
    beginEpoch();
}

void SimulationHost::beginEpoch() {
    generation_ = simulation_->generation();
    ++epoch_;
}

void SimulationHost::noticeGeneration() {
    if (generation_ != simulation_->generation()) beginEpoch();
}

v1::ServerMessage SimulationHost::settings() const {
    v1::ServerMessage message = settingsMessage(simulation_->scene(), scheduler_.speed(), paused_);
    message.mutable_settings()->set_max_impulse(simulation_->maxImpulse());
    message.mutable_settings()->set_rotates(simulation_->buffer(sim::Array::AngularVelocity) != nullptr);
    return message;
}

Result<bool> SimulationHost::advance(Clock::time_point until) {
    for (;;) {
        const auto ended = simulation_->advance();
        if (!ended) return ended;
        if (*ended && pendingSteps_ > 0) --pendingSteps_;
        if (*ended || Clock::now() >= until) return ended;
    }
}

std::optional<Result<sim::Applied>> SimulationHost::change(const sim::Command& command, std::optional<double> speed) {
    auto outcome = simulation_->begin(command);
    if (!outcome) return tl::unexpected(outcome.error());
    if (!outcome->preparation) {
        if (speed) scheduler_.setSpeed(*speed);
        return std::move(outcome->applied);
    }
    const bool reset = std::holds_alternative<sim::Reset>(command);
    change_ = Change{.kind = reset ? Change::Kind::Reset : Change::Kind::Other,
                     .preparation = std::move(outcome->preparation),
                     .speed = speed};
    return std::nullopt;
}

std::optional<Result<sim::Applied>> SimulationHost::load(MakeScene make) {
    change_ = Change{.kind = Change::Kind::Load,
                     .preparation = std::make_unique<sim::Preparation>(*device_, builderOf(std::move(make)))};
    return std::nullopt;
}

Result<void> SimulationHost::step(std::uint32_t count) {
    if (auto right = checkStepCount(count); !right) return right;
    paused_ = true;
    pendingSteps_ += count;
    scheduler_.resume(Clock::now());
    return {};
}

void SimulationHost::resume() {
    paused_ = false;
    pendingSteps_ = 0;
    scheduler_.resume(Clock::now());
}

sim::Applied SimulationHost::query() {
    sim::Applied result = applied();
    result.statistics = simulation_->statistics();
    return result;
}

Result<sim::Applied> SimulationHost::inspect(std::uint64_t sphere) {
    auto seen = sim::inspect(*simulation_, sphere, "sphere");
    if (!seen) return tl::unexpected(seen.error());
    if (auto alive = device_->status(); !alive) return tl::unexpected(alive.error());
    sim::Applied result = applied();
    result.inspected = std::move(*seen);
    return result;
}

std::optional<Result<sim::Applied>> SimulationHost::advanceChange(Clock::duration slice) {
    const auto end = Clock::now() + slice;
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
        const auto done = change_->preparation->advance(std::max(left, std::chrono::milliseconds(0)));
        if (!done) {
            change_.reset();
            return tl::unexpected(done.error());
        }
        if (*done) return finishChange();
        if (Clock::now() >= end) return std::nullopt;
    }
}

sim::Applied SimulationHost::finishChange() {
    Change change = std::move(*change_);
    change_.reset();
    if (change.kind != Change::Kind::Other) script_ = 0;
    if (change.kind == Change::Kind::Load) {
        adopt(sim::Simulation::from(std::move(change.preparation)));
        return applied();
    }
    const bool stood = !change.preparation->letsStep();
    const sim::Applied done = simulation_->adopt(std::move(change.preparation));
    if (change.speed) scheduler_.setSpeed(*change.speed);
    if (stood) scheduler_.resume(Clock::now());
    if (change.kind == Change::Kind::Reset) pendingSteps_ = 0;
    if (simulation_->generation() != generation_) beginEpoch();
    return done;
}

}  // namespace spherule::host
