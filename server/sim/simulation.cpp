#include "sim/simulation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/log.h"
#include "scene/load.h"
#include "scene/quality.h"
#include "sim/need.h"
#include "sim/parameters.h"
#include "sim/preparation.h"

namespace spherule::sim {

namespace {

// Limit of the room for pairs. Spheres in a heap exceed it only if they are deep in each other.
constexpr std::uint64_t mostPairsPerSphere = 128;

static_assert(scene::farMotion == static_cast<double>(FAR_MOTION));

constexpr double keepEvery = 1;  // s simulated

// Returns how far `place` is outside an open face (m); 0 if it is inside. `place` is relative to the bounds' centre.
double beyond(const scene::Bounds& bounds, glm::dvec3 place) {
    const glm::dvec3 half = 0.5 * (bounds.max - bounds.min);
    double farthest = 0;
    for (unsigned face = 0; face < 6; ++face) {
        const int axis = static_cast<int>(face / 2);
        if (bounds.open[face]) farthest = std::max(farthest, (face % 2 == 0 ? -1 : 1) * place[axis] - half[axis]);
    }
    return farthest;
}

// Returns the largest motion of a sphere in `h` seconds, in radii. A sphere outside the bounds counts only if it may be
// back within two steps; the device detects the others.
double farthestMotion(const scene::Scene& scene, const State& state, double h) {
    double farthest = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const double speed = glm::length(glm::dvec3(state.velocity[id]));
        const double ahead = 2 * scene.step * (speed + 2 * scene.step * glm::length(scene.gravity));
        if (beyond(scene.bounds, positionOf(state, id)) > ahead + radiusOf(state, id)) continue;
        farthest = std::max(farthest, speed * h / static_cast<double>(state.position[id].w));
    }
    return farthest;
}

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(compute::Device& device, scene::Scene scene) {
    auto built = builtOf(std::move(scene));
    if (!built) return tl::unexpected(built.error());
    auto preparation = std::make_unique<Preparation>(device, std::move(*built));
    if (auto done = preparation->finish(); !done) return tl::unexpected(done.error());
    return from(std::move(preparation));
}

std::unique_ptr<Simulation> Simulation::from(std::unique_ptr<Preparation> preparation) {
    std::unique_ptr<Simulation> simulation(new Simulation(preparation->device_));
    simulation->initial_ = preparation->built_.scene;
    simulation->take(*preparation);
    return simulation;
}

// Takes the results of a preparation that is done. Cannot fail.
void Simulation::take(Preparation& preparation) {
    scene_ = std::move(preparation.built_.scene);
    radii_ = preparation.radii_;
    pipeline_ = std::move(preparation.pipeline_);
    claim_ = std::move(preparation.claim_);
    settle(claim_, device_, plan());
    counters_ = {};
    sampled_ = false;
    forgot_ = false;
    calm_ = 0;
    patience_ = 0;
    lowered_ = false;
    full_ = false;
    if (const auto& parted = preparation.parted_)
        notices_.push_back(fmt::format(
            "at step {}, spheres were in each other by up to {:.2g} radii, from where {} would make them fly apart: "
            "moved apart beforehand, to {:.2g}, in {} sweeps",
            steps_, parted->before, scene::nameOf(scene_.quality.model), parted->after, parted->sweeps));
    mostSubsteps_ = scene::mostRaised(scene_);
    useSubsteps(scene_.quality.substeps);
    fitToMotion(farthestMotion(scene_, preparation.built_.state, scene_.step / substeps_));
    keep();
}

Simulation::Outcome Simulation::prepare(Anew anew, memory::Claim copies, Preparation::Build build) {
    auto preparation = std::make_unique<Preparation>(device_, std::move(build), std::move(copies));
    anew_ = anew;
    return {.preparation = std::move(preparation)};
}

Simulation::Outcome Simulation::prepare(Anew anew, memory::Claim copies, Built built) {
    auto preparation = std::make_unique<Preparation>(device_, std::move(built), std::move(copies));
    anew_ = anew;
    return {.preparation = std::move(preparation)};
}

Applied Simulation::adopt(std::unique_ptr<Preparation> preparation) {
    if (anew_ == Anew::World) {
        steps_ = 0;
        begun_ = 0;
        left_ = 0;
    }
    take(*preparation);
    if (anew_ != Anew::Nothing) {
        impacts_ = {};
        ++generation_;
    }
    return {.step = steps_};
}

void Simulation::put(const State& state) {
    pipeline_->upload(state, materialsOf(scene_));
}

// Uses the length of the substeps that are left in the step under way, or else of the next step's substeps.
void Simulation::uploadParameters() {
    const double substep = left_ > 0 ? (1 - begun_) * scene_.step / chosen_ : scene_.step / substeps_;
    pipeline_->setParameters(parametersFor(scene_, plan(), radii_, substep));
}

// A step under way is completed with substeps of the new length, or a little shorter.
void Simulation::useSubsteps(std::uint32_t substeps) {
    constexpr double rounding = 1e-9;
    begun_ = shareOfStep();
    substeps_ = substeps;
    if (left_ > 0)
        chosen_ = left_ = static_cast<std::uint32_t>(std::max(1.0, std::ceil((1 - begun_) * substeps - rounding)));
    uploadParameters();
}

double Simulation::shareOfStep() const {
    if (left_ == 0) return 0;
    return begun_ + (1 - begun_) * static_cast<double>(chosen_ - left_) / chosen_;
}

double Simulation::time() const {
    return (static_cast<double>(steps_) + shareOfStep()) * scene_.step;
}

Result<State> Simulation::liveState() {
    State state = snapshot();
    if (auto alive = device_.status(); !alive) return tl::unexpected(alive.error());
    return state;
}

Result<void> Simulation::step() {
    for (;;) {
        const auto ended = advance();
        if (!ended) return tl::unexpected(ended.error());
        if (*ended) return {};
    }
}

Result<bool> Simulation::advance() {
    if (left_ == 0) {
        chosen_ = left_ = substeps_;
        observed_ = observing_ && steps_ % observedEvery == 0;
    }
    pipeline_->substep(observed_);
    if (--left_ > 0) return false;
    ++steps_;
    // The next step has its full length again.
    if (std::exchange(begun_, 0) > 0) uploadParameters();
    if (auto done = guard(); !done) return tl::unexpected(done.error());
    return true;
}

Statistics Simulation::statistics() {
    Statistics now = measure(*pipeline_, scene_);
    now.step = steps_;
    now.time = time();
    now.spheres = count();
    addImpacts(impacts_, *pipeline_);
    now.impacts = impacts_;
    return now;
}

// Runs once per step. Checks that the device is not lost, and that all cell groups found room for their pairs.
Result<void> Simulation::guard() {
    readCounters();  // waits for the step; if the device was lost in it, status() fails and the counters are invalid
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
    // Makes room in time: without room, contacts lose their history, and have no friction for a step.
    const bool nearlyFull = counters_.pairs > plan().pairCapacity / 8 * 7;
    if ((counters_.unlisted > 0 || nearlyFull) && plan().features.has(Feature::Contacts) && !full_) makeRoom();
    fitToMotion(counters_.farthest);
    const double since = static_cast<double>(steps_ - goodStep_) * scene_.step;
    if (!counters_.nonFinite && since > keepEvery - 0.5 * scene_.step) keep();
    return {};
}

void Simulation::keep() {
    pipeline_->download(good_);
    goodStep_ = steps_;
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
    begun_ = 0;
    left_ = 0;
    counters_ = {};
}

// Raises the number of substeps at once when the fastest sphere has moved too far in a substep. Lowers it gradually
// when no sphere does. After each reduction that was too early, waits longer before the next.
void Simulation::fitToMotion(double radiiPerSubstep) {
    constexpr double easier = 0.8;
    constexpr std::uint32_t mostPatience = 256;  // steps
    const std::uint32_t asked = scene_.quality.substeps;
    const double most = std::max(substeps_, mostSubsteps_);
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
    useSubsteps(wanted);
}

// On failure, cell groups without room go on without lists, and no further attempt is made for this scene.
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

compute::Buffer* Simulation::buffer(Array array) {
    return plan().has(array) ? &pipeline_->buffer(array) : nullptr;
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
