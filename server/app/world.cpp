#include "app/world.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/facts.h"
#include "scene/check.h"

namespace spherule::app {

namespace {}  // namespace

Result<std::unique_ptr<World>> World::open(const std::string& deviceChoice, const std::string& scene,
                                           const scene::Overrides& overrides) {
    auto device = compute::openDevice(deviceChoice);
    if (!device) return tl::unexpected(device.error());
    auto loaded = scene::load(scene, (*device)->info().kind, overrides);
    if (!loaded) return tl::unexpected(loaded.error());
    std::unique_ptr<World> world(new World(std::move(*device), overrides));
    if (auto done = world->adopt(std::move(*loaded)); !done) return tl::unexpected(done.error());
    return world;
}

Result<void> World::adopt(scene::Scene scene) {
    auto made = sim::Simulation::create(*device_, std::move(scene));
    if (!made) return tl::unexpected(made.error());
    simulation_ = std::move(*made);
    pacer_.setStep(simulation_->scene().step);
    pacer_.resume(Pacer::Clock::now());
    pendingSteps_ = 0;
    refreshFacts();
    return {};
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

Result<void> World::step() {
    if (pendingSteps_ > 0) --pendingSteps_;
    return simulation_->step();
}

Result<v1::Applied> World::applied() const {
    v1::Applied applied;
    applied.set_step(simulation_->steps());
    return applied;
}

Result<v1::Applied> World::apply(const v1::Command& command) {
    switch (command.kind_case()) {
        case v1::Command::kPause:
            pause();
            return applied();
        case v1::Command::kResume:
            paused_ = false;
            pendingSteps_ = 0;
            pacer_.resume(Pacer::Clock::now());
            return applied();
        case v1::Command::kStep:
            return stepBy(command.step().count());
        case v1::Command::kLoad:
            return load(command.load());
        default:
            break;
    }
    const bool paced = command.has_set() && command.set().has_speed();
    if (paced)
        if (auto right = checkSpeed(command.set().speed()); !right) return tl::unexpected(right.error());
    auto done = simulation_->apply(command);
    if (!done) return done;
    if (paced) pacer_.setSpeed(command.set().speed());
    if (command.has_reset()) pendingSteps_ = 0;
    if (simulation_->generation() != generation_) refreshFacts();
    return done;
}

Result<v1::Applied> World::stepBy(std::uint32_t count) {
    if (auto right = checkStepCount(count); !right) return tl::unexpected(right.error());
    paused_ = true;
    pendingSteps_ = count;
    pacer_.resume(Pacer::Clock::now());
    return applied();
}

// By name only scenes that come with the program: a client does not reach the server's files.
Result<v1::Applied> World::load(const v1::LoadScene& load) {
    Result<scene::Scene> loaded = fail(ErrorKind::Refused, "", "load needs a name or a scene");
    if (load.source_case() == v1::LoadScene::kScene) {
        loaded = scene::build(load.scene(), overrides_).map_error([](Error error) {
            error.where = "scene." + error.where;
            return error;
        });
    } else if (load.source_case() == v1::LoadScene::kName) {
        const auto names = scene::names();
        if (std::ranges::find(names, load.name()) == names.end())
            return fail(ErrorKind::Refused, "name",
                        fmt::format("is {}; known are {}", scene::shown(load.name()), fmt::join(names, ", ")));
        loaded = scene::load(load.name(), device_->info().kind, overrides_);
    }
    if (!loaded) return tl::unexpected(loaded.error());
    if (auto done = adopt(std::move(*loaded)); !done) return tl::unexpected(done.error());
    return applied();
}

}  // namespace spherule::app
