#include "sim/simulation.h"

#include <cmath>

#include "core/log.h"
#include "sim/parameters.h"

namespace spherule::sim {

namespace {

// Room for pairs ends here: as many as spheres in a heap can have only if they are deep in each other.
constexpr std::uint64_t mostPairsPerSphere = 128;

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(compute::Device& device, scene::Scene scene) {
    std::unique_ptr<Simulation> simulation(new Simulation(device, std::move(scene)));
    if (auto done = simulation->reset(); !done) return tl::unexpected(done.error());
    return simulation;
}

Result<void> Simulation::adopt(scene::Scene scene, State state) {
    const Radii radii = radiiOf(scene);
    auto made = Pipeline::create(device_, planFor(scene, scene::featuresOf(scene), state.count(), radii));
    if (!made) return tl::unexpected(made.error());
    scene_ = std::move(scene);
    radii_ = radii;
    pipeline_ = std::move(*made);
    for (glm::vec4& velocity : state.velocity) velocity.w = std::abs(velocity.w);
    sampled_ = false;
    full_ = false;
    put(state);
    uploadConstants();
    return {};
}

void Simulation::put(const State& state) {
    std::vector<std::uint8_t> materials;
    materials.reserve(state.count());
    for (const scene::Sphere& sphere : scene_.spheres) materials.push_back(sphere.material);
    pipeline_->upload(state, materials);
}

// What the kernels read of the scene besides the spheres' state.
void Simulation::uploadConstants() {
    if (plan().has(Array::Obstacles)) pipeline_->write<layout::Obstacle>(Array::Obstacles, obstaclesFor(scene_));
    if (plan().has(Array::Laws)) pipeline_->write<layout::Law>(Array::Laws, lawsFor(scene_));
    pipeline_->setParameters(parametersFor(scene_, plan(), radii_, wire_));
}

Result<State> Simulation::liveState() {
    State state = snapshot();
    if (auto alive = device_.status(); !alive) return tl::unexpected(alive.error());
    return state;
}

Result<void> Simulation::reset() {
    if (auto done = adopt(initial_, stateOf(initial_)); !done) return done;
    steps_ = 0;
    time_ = 0;
    ++generation_;
    return {};
}

Result<void> Simulation::step() {
    for (std::uint32_t k = 0; k < scene_.quality.substeps; ++k) pipeline_->substep();
    ++steps_;
    time_ += scene_.step;
    return guard();
}

// Once a step: the device is still there, and every cell group has found room for its pairs.
Result<void> Simulation::guard() {
    if (auto alive = device_.status(); !alive) return alive;
    readCounters();
    if (counters_.sampled > 0 && !sampled_) {
        sampled_ = true;
        spdlog::warn("{} cell groups are so crowded that in a substep each sphere meets only some of the others",
                     counters_.sampled);
    }
    // In time: once there is too little, contacts forget what they remember, and go without friction for a step.
    const bool nearlyFull = counters_.pairs > plan().pairCapacity / 8 * 7;
    if ((counters_.unlisted > 0 || nearlyFull) && plan().features.contacts && !full_) makeRoom();
    return {};
}

// On failure the simulation goes on without lists where it must, and nothing is tried again for this scene.
void Simulation::makeRoom() {
    const std::uint64_t most = std::min<std::uint64_t>(mostPairsPerSphere * count(), UNLISTED - 1);
    const std::uint64_t wanted = 2 * std::uint64_t{std::max(counters_.pairs, plan().pairCapacity)};
    const auto capacity = static_cast<std::uint32_t>(std::min(wanted, most));
    if (capacity <= plan().pairCapacity) {
        full_ = true;
        spdlog::warn("more than {} pairs per sphere; without lists while that is so, slower", mostPairsPerSphere);
        return;
    }
    if (counters_.unlisted > 0)
        spdlog::info("{} cell groups had no room for their pairs; making room for {}", counters_.unlisted, capacity);
    if (auto grown = pipeline_->growPairs(capacity); !grown) {
        full_ = true;
        spdlog::warn("{}; without lists while there are more, slower", grown.error().text());
        return;
    }
    pipeline_->setParameters(parametersFor(scene_, plan(), radii_, wire_));
}

void Simulation::setWireGrid(const v1::WireGrid& grid) {
    wire_ = grid;
    pipeline_->setParameters(parametersFor(scene_, plan(), radii_, wire_));
}

std::unique_ptr<compute::ReadBack> Simulation::pack() {
    pipeline_->runPack();
    return device_.startReadBack(pipeline_->buffer(Array::Packed), plan().bytesOf(Array::Packed));
}

void Simulation::readCounters() {
    const auto words = pipeline_->read<std::uint32_t>(Array::Counters);
    counters_ = {.pairs = words[COUNTER_PAIRS],
                 .unlisted = words[COUNTER_UNLISTED],
                 .sampled = words[COUNTER_SAMPLED],
                 .nonFinite = words[COUNTER_NON_FINITE] > 0,
                 .firstNonFinite = ~words[COUNTER_FIRST_ID],
                 .rebuilds = words[COUNTER_REBUILDS]};
}

}  // namespace spherule::sim
