#include "app/world.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/facts.h"
#include "scene/check.h"

namespace spherule::app {

namespace {

// Of a scene, on a thread without the device.
sim::Preparation::Build builderOf(std::function<Result<scene::Scene>(Progress&)> make) {
    return [make = std::move(make)](Progress& progress) -> Result<sim::Built> {
        auto scene = make(progress);
        if (!scene) return tl::unexpected(scene.error());
        return sim::builtOf(std::move(*scene));
    };
}

}  // namespace

Result<std::unique_ptr<World>> World::open(const std::string& deviceChoice, const std::string& scene,
                                           const scene::Overrides& overrides) {
    auto device = compute::openDevice(deviceChoice);
    if (!device) return tl::unexpected(device.error());
    std::unique_ptr<World> world(new World(std::move(*device), overrides));
    const std::string kind = world->device_->info().kind;
    auto preparation = std::make_unique<sim::Preparation>(
        *world->device_, builderOf([=](Progress& progress) { return scene::load(scene, kind, overrides, &progress); }));
    if (auto done = preparation->finish(); !done) return tl::unexpected(done.error());
    world->adopt(std::move(preparation));
    return world;
}

void World::adopt(std::unique_ptr<sim::Preparation> preparation) {
    simulation_ = sim::Simulation::from(std::move(preparation));
    pacer_.setStep(simulation_->scene().step);
    pacer_.resume(Clock::now());
    pendingSteps_ = 0;
    refreshFacts();
}

void World::refreshFacts() {
    generation_ = simulation_->generation();
    ++epoch_;
}

v1::ServerMessage World::facts() const {
    return factsMessage(*simulation_, epoch_);
}

v1::ServerMessage World::settings() const {
    return settingsMessage(simulation_->scene(), pacer_.speed(), paused_);
}

Result<bool> World::advance(Clock::time_point until) {
    for (;;) {
        const auto ended = simulation_->advance();
        if (!ended) return ended;
        if (*ended && pendingSteps_ > 0) --pendingSteps_;
        if (*ended || Clock::now() >= until) return ended;
    }
}

v1::Applied World::applied() const {
    v1::Applied applied;
    applied.set_step(simulation_->steps());
    return applied;
}

std::optional<Result<v1::Applied>> World::apply(const v1::Command& command) {
    switch (command.kind_case()) {
        case v1::Command::kPause:
            pause();
            return applied();
        case v1::Command::kResume:
            paused_ = false;
            pendingSteps_ = 0;
            pacer_.resume(Clock::now());
            return applied();
        case v1::Command::kStep:
            return stepBy(command.step().count());
        case v1::Command::kLoad:
            return load(command.load());
        default:
            return simulate(command);
    }
}

std::optional<Result<v1::Applied>> World::simulate(const v1::Command& command) {
    const bool paced = command.has_set() && command.set().has_speed();
    if (paced)
        if (auto right = checkSpeed(command.set().speed()); !right) return tl::unexpected(right.error());
    auto outcome = simulation_->begin(command);
    if (!outcome) return tl::unexpected(outcome.error());
    if (!outcome->preparation) {
        if (paced) pacer_.setSpeed(command.set().speed());
        return std::move(outcome->applied);
    }
    change_ = std::move(outcome->preparation);
    changeKind_ = command.kind_case();
    changeSpeed_ = paced ? std::optional(command.set().speed()) : std::nullopt;
    return std::nullopt;
}

std::optional<Result<v1::Applied>> World::advanceChange(Clock::duration slice) {
    const auto end = Clock::now() + slice;
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
        const auto done = change_->advance(std::max(left, std::chrono::milliseconds(0)));
        if (!done) {
            change_.reset();
            return tl::unexpected(done.error());
        }
        if (*done) return finishChange();
        if (Clock::now() >= end) return std::nullopt;
    }
}

v1::Applied World::finishChange() {
    if (changeKind_ == v1::Command::kLoad) {
        adopt(std::move(change_));
        return applied();
    }
    v1::Applied done = simulation_->adopt(std::move(change_));
    if (changeSpeed_) pacer_.setSpeed(*changeSpeed_);
    pacer_.resume(Clock::now());
    if (changeKind_ == v1::Command::kReset) pendingSteps_ = 0;
    if (simulation_->generation() != generation_) refreshFacts();
    return done;
}

// Adds to those that are still to be done.
Result<v1::Applied> World::stepBy(std::uint32_t count) {
    if (auto right = checkStepCount(count); !right) return tl::unexpected(right.error());
    paused_ = true;
    pendingSteps_ += count;
    pacer_.resume(Clock::now());
    return applied();
}

// By name only scenes that come with the program: a client does not reach the server's files.
std::optional<Result<v1::Applied>> World::load(const v1::LoadScene& load) {
    std::function<Result<scene::Scene>(Progress&)> make;
    if (load.source_case() == v1::LoadScene::kScene) {
        make = [scene = load.scene(), overrides = overrides_](Progress& progress) {
            return scene::build(scene, overrides, &progress).map_error([](Error error) {
                if (!error.where.empty()) error.where = "scene." + error.where;
                return error;
            });
        };
    } else if (load.source_case() == v1::LoadScene::kName) {
        const auto names = scene::names();
        if (std::ranges::find(names, load.name()) == names.end())
            return fail(ErrorKind::Refused, "name",
                        fmt::format("is {}; known are {}", scene::shown(load.name()), fmt::join(names, ", ")));
        make = [name = load.name(), kind = device_->info().kind, overrides = overrides_](Progress& progress) {
            return scene::load(name, kind, overrides, &progress);
        };
    } else {
        return fail(ErrorKind::Refused, "", "load needs a name or a scene");
    }
    change_ = std::make_unique<sim::Preparation>(*device_, builderOf(std::move(make)));
    changeKind_ = v1::Command::kLoad;
    return std::nullopt;
}

}  // namespace spherule::app
