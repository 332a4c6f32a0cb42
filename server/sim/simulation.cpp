#include "sim/simulation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/log.h"
#include "scene/load.h"
#include "scene/quality.h"
#include "scene/shapes.h"
#include "sim/memory_needs.h"
#include "sim/parameters.h"
#include "sim/preparation.h"

namespace spherule::sim {

namespace {

// Limit of the room for pairs. Spheres in a heap exceed it only if they are deep in each other.
constexpr std::uint64_t maxPairsPerSphere = 128;

constexpr double saveInterval = 1;  // s simulated

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(compute::Device& device, scene::Scene scene) {
    auto built = withInitialState(std::move(scene));
    if (!built) return tl::unexpected(built.error());
    auto preparation = std::make_unique<Preparation>(device, std::move(*built));
    if (auto done = preparation->finish(); !done) return tl::unexpected(done.error());
    return from(std::move(preparation));
}

std::unique_ptr<Simulation> Simulation::from(std::unique_ptr<Preparation> preparation) {
    std::unique_ptr<Simulation> simulation(new Simulation(preparation->device_));
    simulation->initial_ = preparation->built_.scene;
    simulation->population_ = Population(preparation->built_.state.count());
    simulation->flows_ = Flows(preparation->built_.scene);
    simulation->install(*preparation);
    return simulation;
}

// Adds the sums of the device, in scenes with contact sums.
void Simulation::takeContactSums() {
    if (!hasContactSums()) return;
    addContactSums(contactSums_, *pipeline_);
    addSurfaceLoads(contactSums_, scene::surfacesOf(scene_), *pipeline_, loadUnits_);
    contactSums_.seconds = time() - sumsBegin_;
}

// Ends a stretch of contact sums, before an event other than motion changes the energies that contacts hold.
void Simulation::closeContactSums() {
    if (!hasContactSums()) return;
    contactSums_ = *statistics().contactSums;
}

// Begins a stretch of contact sums, in units that suit the present spheres.
void Simulation::openContactSums() {
    if (!hasContactSums() && !drives_->any()) return;
    loadUnits_ = LoadUnits::of(scene_);
    uploadParameters();
    if (!hasContactSums()) return;
    elasticBefore_ = measure(*pipeline_, scene_).elasticEnergy;
}

// Takes the results of a preparation that is done. Cannot fail.
void Simulation::install(Preparation& preparation) {
    if (pipeline_) closeContactSums();
    ++partsVersion_;
    scene_ = std::move(preparation.built_.scene);
    radii_ = preparation.basis_.radii;
    pipeline_ = std::move(preparation.pipeline_);
    claim_ = std::move(preparation.claim_);
    settleClaim(claim_, device_, plan());
    counters_ = {};
    noticedSampled_ = noticedCutShort_ = noticedDropped_ = false;
    quietSteps_ = 0;
    backoff_ = 0;
    lowered_ = false;
    tooFast_ = false;
    pairsExhausted_ = false;
    if (const auto& resolved = preparation.resolvedOverlaps_)
        notices_.push_back(fmt::format(
            "at step {}, spheres were in each other by up to {:.2g} radii, from where {} would make them fly apart: "
            "moved apart beforehand, to {:.2g}, in {} sweeps",
            steps_, resolved->before, scene::nameOf(scene_.quality.model), resolved->after, resolved->sweeps));
    maxSubsteps_ = scene::maxRaisedSubsteps(scene_);
    obstacleRows_.emplace(scene_, plan().meshes.get());
    drives_.emplace(scene_, plan());
    drives_->startAt(scene_, time());
    useSubsteps(scene_.quality.substeps);
    limitMotionOf(preparation.built_.state);
    openContactSums();
    saveLastFinite();
}

Simulation::Outcome Simulation::prepareSpawn(memory::Claim copies, Preparation::Build build) {
    auto preparation = std::make_unique<Preparation>(device_, std::move(build), std::move(copies), *this);
    resetScope_ = ResetScope::Spheres;
    return {.preparation = std::move(preparation)};
}

Simulation::Outcome Simulation::prepare(ResetScope scope, memory::Claim copies, SceneAndState built) {
    auto preparation = std::make_unique<Preparation>(device_, std::move(built), std::move(copies));
    resetScope_ = scope;
    return {.preparation = std::move(preparation)};
}

Applied Simulation::adopt(std::unique_ptr<Preparation> preparation) {
    if (preparation->appends_) {
        append(*preparation);
        return {.step = steps_};
    }
    if (preparation->change_) {
        const scene::PartChange made = preparation->made_;
        takePart(std::move(preparation->built_.scene), made, preparation->pipeline_ ? preparation.get() : nullptr);
        return {.step = steps_, .number = made.number};
    }
    if (preparation->continues_ != nullptr) {
        continueWith(*preparation);
        return {.step = steps_, .obstacle = preparation->edit_.number};
    }
    const std::uint32_t spheres = preparation->built_.state.count();
    bool newHandles = false;
    if (resetScope_ == ResetScope::World) {
        steps_ = 0;
        remainderBegin_ = substepsLeft_ = substepsDone_ = 0;
        pulls_.clear();
        population_ = Population(spheres);
        flows_ = Flows(preparation->built_.scene);
    } else {
        newHandles = !population_.plain();
        population_.add(spheres - population_.count(), steps_);
        population_.renumber();
    }
    install(*preparation);
    if (newHandles) ++generation_;
    if (resetScope_ != ResetScope::Nothing) {
        impacts_ = {};
        contactSums_ = lastFiniteSums_ = {};
        sumsBegin_ = time();
        ++generation_;
    }
    return {.step = steps_};
}

// Uses the length of the substeps that are left in the step under way, or else of the next step's substeps.
void Simulation::uploadParameters() {
    const double substep =
        substepsLeft_ > 0 ? (1 - remainderBegin_) * scene_.step / remainderSubsteps_ : scene_.step / substeps_;
    layout::Parameters parameters = parametersFor(scene_, plan(), radii_, substep);
    parameters.perImpulseUnit = static_cast<float>(1 / loadUnits_.impulse);
    parameters.perMomentUnit = static_cast<float>(1 / loadUnits_.moment);
    pipeline_->setParameters(parameters);
    placeObstacles(time());
    keepPulls();
}

// A step under way is completed with substeps of the new length, or a little shorter.
void Simulation::useSubsteps(std::uint32_t substeps) {
    constexpr double rounding = 1e-9;
    remainderBegin_ = shareOfStep();
    substeps_ = substeps;
    if (substepsLeft_ > 0)
        remainderSubsteps_ = substepsLeft_ =
            static_cast<std::uint32_t>(std::max(1.0, std::ceil((1 - remainderBegin_) * substeps - rounding)));
    uploadParameters();
}

double Simulation::shareOfStep() const {
    if (substepsLeft_ == 0) return 0;
    return remainderBegin_ +
           (1 - remainderBegin_) * static_cast<double>(remainderSubsteps_ - substepsLeft_) / remainderSubsteps_;
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
    if (substepsLeft_ == 0) {
        remainderSubsteps_ = substepsLeft_ = substeps_;
        stepObserved_ = observing_ && steps_ % observedEvery == 0;
    }
    // `balanced` solves the contacts before the spheres move.
    const TimeSpan times = nextSubstep();
    if (drives_->any()) drives_->predict(scene_, times);
    placeObstacles(scene_.quality.model == scene::Model::Balanced ? times.begin : times.end);
    pipeline_->substep(stepObserved_);
    if (drives_->any()) drives_->advance(scene_, times, *pipeline_, loadUnits_);
    ++substepsDone_;
    if (--substepsLeft_ > 0) return false;
    substepsDone_ = 0;
    pipeline_->endStep();
    ++steps_;
    placeObstacles(time());
    // The next step has its full length again.
    if (std::exchange(remainderBegin_, 0) > 0) uploadParameters();
    if (auto done = checkStep(); !done) return tl::unexpected(done.error());
    return true;
}

Statistics Simulation::statistics() {
    Statistics now = measure(*pipeline_, scene_);
    now.step = steps_;
    now.time = time();
    now.spheres = count();
    now.born = population_.born();
    now.removed = population_.removed();
    flows_.addTo(now, scene_);
    addImpacts(impacts_, *pipeline_);
    now.impacts = impacts_;
    if (hasContactSums()) {
        takeContactSums();
        now.contactSums = contactSums_;
        setMeans(now, contactSums_, scene_);
        now.contactSums->dissipated -= now.elasticEnergy - elasticBefore_;  // the energy in springs is not lost
    }
    return now;
}

// Runs once per step. Checks that the device is not lost, and that all cell groups found room for their pairs.
Result<void> Simulation::checkStep() {
    readCounters();  // waits for the step; if the device was lost in it, status() fails and the counters are invalid
    if (auto alive = device_.status(); !alive) return alive;
    if (hasContactSums())  // keeps them far within 64 bits
        addSurfaceLoads(contactSums_, scene::surfacesOf(scene_), *pipeline_, loadUnits_);
    if (counters_.sampled > 0 && !std::exchange(noticedSampled_, true))
        notices_.push_back(fmt::format(
            "at step {}, {} spheres are so crowded that in a substep each of them meets only some of the others",
            steps_, counters_.sampled));
    if (counters_.cutShort > 0 && !std::exchange(noticedCutShort_, true))
        notices_.push_back(fmt::format(
            "at step {}, a cell group is so crowded that the software renderer cuts its list of pairs short: spheres "
            "there may pass through each other. Use --device cpu",
            steps_));
    if (counters_.droppedWallContacts > 0 && !std::exchange(noticedDropped_, true))
        notices_.push_back(fmt::format(
            "at step {}, a sphere touches more than {} walls at once: further ones do not hold it by friction", steps_,
            plan().maxWallHistory));
    // Makes room in time: without room, contacts lose their slip, and have no friction for a step.
    const bool nearlyFull = counters_.pairs > plan().pairCapacity / 8 * 7;
    if ((counters_.unlisted > 0 || nearlyFull) && plan().features.has(Feature::Contacts) && !pairsExhausted_)
        growPairs();
    limitMotionPerSubstep(std::max(counters_.largestMotion, motionOfObstacles()));
    if (counters_.sunk > 0 && !counters_.nonFinite) emptySinks();
    if (!scene_.emitters.empty() && !counters_.nonFinite) emit();
    const double since = static_cast<double>(steps_ - lastFiniteStep_) * scene_.step;
    if (!counters_.nonFinite && since > saveInterval - 0.5 * scene_.step) saveLastFinite();
    return {};
}

void Simulation::saveLastFinite() {
    pipeline_->keepState();
    lastFiniteStep_ = steps_;
    lastFiniteDrives_ = drives_->states(scene_);
    lastFiniteFlows_ = flows_;
    lastFiniteSpheres_.reset();
    takeContactSums();  // also keeps the sums of the device short
    lastFiniteSums_ = contactSums_;
}

std::string Simulation::divergence() const {
    const Population& before = lastFiniteSpheres_ ? lastFiniteSpheres_->population : population_;
    const std::uint32_t handle = counters_.firstNonFinite;
    const std::uint32_t now = handle < population_.handles() ? population_.rankOfHandle(handle) : Population::noRank;
    if (now >= count()) return fmt::format("a sphere has no finite position any more at step {}", steps_);
    const std::uint64_t id = population_.idAt(now);
    const auto rank = before.rankOf(id);
    if (!rank) return fmt::format("sphere {} has no finite position any more at step {}", id, steps_);
    const State lastFinite = inIdOrder(pipeline_->keptState(before.count()), before);
    const glm::dvec3 x = positionOf(lastFinite, *rank) + scene_.bounds.centre();
    return fmt::format(
        "sphere {} has no finite position any more at step {}; at step {} it was at {:.4g} {:.4g} {:.4g} m "
        "with {:.3g} m/s",
        id, steps_, lastFiniteStep_, x.x, x.y, x.z, glm::length(velocityOf(lastFinite, *rank)));
}

void Simulation::rollback() {
    remainderBegin_ = substepsLeft_ = substepsDone_ = 0;
    if (lastFiniteSpheres_) {
        const std::uint64_t next = population_.nextId();
        population_ = std::move(lastFiniteSpheres_->population);
        population_.skipTo(next);
        scene_.spheres = std::move(lastFiniteSpheres_->spheres);
        scene_.groups = std::move(lastFiniteSpheres_->groups);
        lastFiniteSpheres_.reset();
        ++generation_;
    }
    const State kept = inIdOrder(pipeline_->keptState(count()), population_);
    upload(kept);
    steps_ = lastFiniteStep_;
    drives_->restore(scene_, lastFiniteDrives_, time());
    flows_ = lastFiniteFlows_;
    counters_ = {};
    contactSums_ = lastFiniteSums_;
    const double elasticBefore = elasticBefore_;
    openContactSums();
    contactSums_.dissipated -= elasticBefore_ - elasticBefore;
}

// On failure, cell groups without room go on without lists, and no further attempt is made for this scene.
void Simulation::growPairs() {
    const std::uint64_t most = std::min<std::uint64_t>(maxPairsPerSphere * count(), UNLISTED - 1);
    const std::uint64_t target = 2 * std::uint64_t{std::max(counters_.pairs, plan().pairCapacity)};
    const auto capacity = static_cast<std::uint32_t>(std::min(target, most));
    if (capacity <= plan().pairCapacity) {
        if (counters_.unlisted == 0) return;
        pairsExhausted_ = true;
        spdlog::warn("more than {} pairs per sphere; without lists while that is so, slower", maxPairsPerSphere);
        return;
    }
    if (counters_.unlisted > 0)
        spdlog::info("{} cell groups had no room for their pairs; making room for {}", counters_.unlisted, capacity);
    auto grown = pipeline_->growPairs(capacity);
    if (grown) {
        settleClaim(claim_, device_, plan());
    } else {
        pairsExhausted_ = true;
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
    // The pairs of movers have two rooms.
    const std::uint32_t pairs =
        words[COUNTER_MOVER_LISTS] == 0
            ? words[COUNTER_PAIRS]
            : words[COUNTER_ALL_PAIRS] + 2 * (words[COUNTER_PAIRS] - words[COUNTER_MOVER_PAIRS]);
    counters_ = {.pairs = pairs,
                 .unlisted = words[COUNTER_UNLISTED],
                 .sampled = words[COUNTER_SAMPLED],
                 .cutShort = words[COUNTER_CUT_SHORT],
                 .droppedWallContacts = words[COUNTER_DROPPED_WALLS],
                 .nonFinite = words[COUNTER_NON_FINITE] > 0,
                 .firstNonFinite = ~words[COUNTER_FIRST_ID],
                 .rebuilds = words[COUNTER_REBUILDS],
                 .sunk = words[COUNTER_SUNK],
                 .largestMotion = static_cast<double>(std::bit_cast<float>(words[COUNTER_LARGEST_MOTION]))};
    if (counters_.largestMotion > 0) {
        const std::uint32_t none = 0;
        pipeline_->write<std::uint32_t>(Array::Counters, std::span(&none, 1), COUNTER_LARGEST_MOTION);
    }
}

}  // namespace spherule::sim
