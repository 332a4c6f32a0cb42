#include "sim/simulation.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/log.h"
#include "scene/load.h"
#include "scene/quality.h"
#include "sim/need.h"
#include "sim/parameters.h"
#include "sim/relax.h"

namespace spherule::sim {

namespace {

// Room for pairs ends here: as many as spheres in a heap can have only if they are deep in each other.
constexpr std::uint64_t mostPairsPerSphere = 128;

constexpr double keepEvery = 1;  // s simulated

// In radii, in h seconds.
double farthestMotion(const State& state, double h) {
    double farthest = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const double speed = glm::length(glm::dvec3(state.velocity[id]));
        farthest = std::max(farthest, speed * h / static_cast<double>(state.position[id].w));
    }
    return farthest;
}

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(compute::Device& device, scene::Scene scene) {
    const Plan plan =
        planFor(scene, scene::featuresOf(scene), static_cast<std::uint32_t>(scene.spheres.size()), radiiOf(scene));
    auto claim = claimFor(device, plan);
    if (!claim) return tl::unexpected(claim.error());
    std::unique_ptr<Simulation> simulation(new Simulation(device, std::move(scene)));
    simulation->claim_ = std::move(*claim);
    if (auto done = simulation->reset(); !done) return tl::unexpected(done.error());
    return simulation;
}

Result<void> Simulation::adopt(scene::Scene scene, State state) {
    const Radii radii = radiiOf(scene);
    Plan plan = planFor(scene, scene::featuresOf(scene), state.count(), radii);
    // What replaces other arrays is made beside them.
    auto beside = memory::Claim::make("", "other arrays of the scene", pipeline_ ? arraysOnHost(device_, plan) : 0);
    if (!beside) return tl::unexpected(beside.error());
    auto made = Pipeline::create(device_, std::move(plan));
    if (!made) return tl::unexpected(made.error());
    scene_ = std::move(scene);
    radii_ = radii;
    pipeline_ = std::move(*made);
    for (glm::vec4& velocity : state.velocity) velocity.w = std::abs(velocity.w);
    counters_ = {};
    sampled_ = false;
    forgot_ = false;
    calm_ = 0;
    patience_ = 0;
    lowered_ = false;
    full_ = false;
    substeps_ = scene_.quality.substeps;
    put(state);
    uploadConstants();
    settle(claim_, device_, this->plan());
    *beside = {};
    if (auto done = takeApart(state); !done) return done;
    fitToMotion(farthestMotion(state, scene_.step / substeps_));
    keep();
    return {};
}

// Spheres that begin deep in each other would fly apart.
Result<void> Simulation::takeApart(State& state) {
    const double tolerated = deepestBearable(scene_);
    if (!std::isfinite(tolerated)) return {};
    const double deepest = statistics().deepest();
    if (!(deepest > tolerated)) return {};
    spdlog::info("spheres are in each other by up to {:.2g} radii; pushing them apart first", deepest);
    auto relaxed = relax(device_, scene_, state, tolerated);
    if (!relaxed) return tl::unexpected(relaxed.error());
    notices_.push_back(fmt::format(
        "at step {}, spheres were in each other by up to {:.2g} radii, from where {} would make them fly apart: moved "
        "apart beforehand, to {:.2g}, in {} sweeps",
        steps_, deepest, scene::nameOf(scene_.quality.model), relaxed->overlap, relaxed->sweeps));
    state = std::move(relaxed->state);
    put(state);
    return {};
}

void Simulation::put(const State& state) {
    std::vector<std::uint8_t> materials;
    materials.reserve(state.count());
    for (const scene::Sphere& sphere : scene_.spheres) materials.push_back(sphere.material);
    pipeline_->upload(state, materials);
}

void Simulation::uploadParameters() {
    pipeline_->setParameters(parametersFor(scene_, plan(), radii_, substeps_));
}

// What the kernels read of the scene besides the spheres' state.
void Simulation::uploadConstants() {
    if (plan().has(Array::Obstacles)) pipeline_->write<layout::Obstacle>(Array::Obstacles, obstaclesFor(scene_));
    if (plan().has(Array::Laws)) pipeline_->write<layout::Law>(Array::Laws, lawsFor(scene_));
    uploadParameters();
}

Result<State> Simulation::liveState() {
    State state = snapshot();
    if (auto alive = device_.status(); !alive) return tl::unexpected(alive.error());
    return state;
}

Result<void> Simulation::reset() {
    auto copies = memory::Claim::make("", "the scene as it began", pipeline_ ? copiesToChange(plan()) : 0);
    if (!copies) return tl::unexpected(copies.error());
    if (auto done = adopt(initial_, stateOf(initial_)); !done) return done;
    steps_ = 0;
    time_ = 0;
    goodStep_ = 0;
    goodTime_ = 0;
    impacts_ = {};
    ++generation_;
    return {};
}

Result<void> Simulation::step() {
    const bool observed = observing_ && steps_ % observedEvery == 0;
    for (std::uint32_t k = 0; k < substeps_; ++k) pipeline_->substep(observed);
    ++steps_;
    time_ += scene_.step;
    return guard();
}

Statistics Simulation::statistics() {
    Statistics now = measure(*pipeline_, scene_);
    addImpacts(impacts_, *pipeline_);
    now.impacts = impacts_;
    return now;
}

// Once a step: the device is still there, and every cell group has found room for its pairs.
Result<void> Simulation::guard() {
    readCounters();  // waits for the step: a device that was lost in it is lost by now, and the counters are none
    if (auto alive = device_.status(); !alive) return alive;
    if (counters_.sampled > 0 && !sampled_) {
        sampled_ = true;
        notices_.push_back(fmt::format(
            "at step {}, {} cell groups are so crowded that in a substep each sphere meets only some of the others",
            steps_, counters_.sampled));
    }
    if (counters_.forgotten > 0 && !forgot_) {
        forgot_ = true;
        notices_.push_back(fmt::format(
            "at step {}, a sphere touches more than {} walls at once: further ones do not hold it by friction", steps_,
            plan().wallContacts));
    }
    // In time: once there is too little, contacts forget what they remember, and go without friction for a step.
    const bool nearlyFull = counters_.pairs > plan().pairCapacity / 8 * 7;
    if ((counters_.unlisted > 0 || nearlyFull) && plan().features.contacts && !full_) makeRoom();
    fitToMotion(counters_.farthest);
    const double since = static_cast<double>(steps_ - goodStep_) * scene_.step;
    if (!counters_.nonFinite && since > keepEvery - 0.5 * scene_.step) keep();
    return {};
}

void Simulation::keep() {
    pipeline_->download(good_);
    goodStep_ = steps_;
    goodTime_ = time_;
}

std::string Simulation::divergence() const {
    const std::uint32_t id = counters_.firstNonFinite;
    const State good = inIdOrder(good_);
    if (id >= good.count()) return fmt::format("a sphere has no finite position any more at step {}", steps_);
    const glm::dvec3 x = positionOf(good, id) + scene_.bounds.centre();
    return fmt::format(
        "sphere {} has no finite position any more at step {}; at step {} it was at {:.4g} {:.4g} {:.4g} m "
        "with {:.3g} m/s",
        id, steps_, goodStep_, x.x, x.y, x.z, glm::length(velocityOf(good, id)));
}

void Simulation::restore() {
    put(inIdOrder(good_));
    steps_ = goodStep_;
    time_ = goodTime_;
    counters_ = {};
}

// Raises the substeps at once when the fastest sphere has moved too far in one, and lowers them by and by when nothing
// does any more: with more patience each time that this was too early.
void Simulation::fitToMotion(double radiiPerSubstep) {
    constexpr double easier = 0.8;
    constexpr double mostTimes = 256;
    constexpr std::uint32_t mostPatience = 256;  // steps
    const std::uint32_t asked = scene_.quality.substeps;
    const double most = std::max(1.0 * substeps_, std::min<double>(mostTimes * asked, scene::maxSubsteps));
    std::uint32_t wanted = substeps_;
    bool enough = true;
    ++calm_;
    if (radiiPerSubstep > static_cast<double>(FAR_MOTION)) {
        const double needed = std::ceil(substeps_ * radiiPerSubstep / static_cast<double>(FAR_MOTION));
        enough = needed <= most;
        wanted = static_cast<std::uint32_t>(std::min(needed, most));
        if (calm_ > 2 * mostPatience) patience_ = 0;
        if (lowered_) patience_ = std::clamp(2 * patience_, 4U, mostPatience);
        lowered_ = false;
        calm_ = 0;
    } else if (substeps_ > asked && calm_ > patience_) {
        wanted = std::max(asked, static_cast<std::uint32_t>(easier * substeps_));
        lowered_ = true;
    }
    if (wanted == substeps_) return;
    if (substeps_ == asked)
        notices_.push_back(fmt::format(
            "at step {}, a sphere moves {:.2g} radii in a substep: {} substeps per step in "
            "place of {} while anything is so fast{}",
            steps_, radiiPerSubstep, wanted, asked, enough ? "" : "; even so it may pass through what it should hit"));
    else if (wanted == asked)
        notices_.push_back(fmt::format("at step {}, back to {} substeps per step", steps_, asked));
    substeps_ = wanted;
    uploadParameters();
}

// On failure the simulation goes on without lists where it must, and nothing is tried again for this scene.
void Simulation::makeRoom() {
    const std::uint64_t most = std::min<std::uint64_t>(mostPairsPerSphere * count(), UNLISTED - 1);
    const std::uint64_t wanted = 2 * std::uint64_t{std::max(counters_.pairs, plan().pairCapacity)};
    const auto capacity = static_cast<std::uint32_t>(std::min(wanted, most));
    if (capacity <= plan().pairCapacity) {
        if (counters_.unlisted == 0) return;
        full_ = true;
        spdlog::warn("more than {} pairs per sphere; without lists while that is so, slower", mostPairsPerSphere);
        return;
    }
    if (counters_.unlisted > 0)
        spdlog::info("{} cell groups had no room for their pairs; making room for {}", counters_.unlisted, capacity);
    auto grown = pipeline_->growPairs(capacity);
    if (grown) {
        settle(claim_, device_, plan());
    } else {
        full_ = true;
        spdlog::warn("{}; without lists while there are more, slower", grown.error().text());
        return;
    }
    uploadParameters();
}

TierSource Simulation::tierSource() {
    return {.position = &pipeline_->buffer(Array::Position),
            .slotOf = plan().has(Array::SlotOf) ? &pipeline_->buffer(Array::SlotOf) : nullptr};
}

void Simulation::readCounters() {
    const auto words = pipeline_->read<std::uint32_t>(Array::Counters);
    counters_ = {.pairs = words[COUNTER_PAIRS],
                 .unlisted = words[COUNTER_UNLISTED],
                 .sampled = words[COUNTER_SAMPLED],
                 .forgotten = words[COUNTER_FORGOTTEN],
                 .nonFinite = words[COUNTER_NON_FINITE] > 0,
                 .firstNonFinite = ~words[COUNTER_FIRST_ID],
                 .rebuilds = words[COUNTER_REBUILDS],
                 .farthest = static_cast<double>(std::bit_cast<float>(words[COUNTER_FASTEST]))};
    if (counters_.farthest > 0) {
        const std::uint32_t none = 0;
        pipeline_->write<std::uint32_t>(Array::Counters, std::span(&none, 1), COUNTER_FASTEST);
    }
}

}  // namespace spherule::sim
