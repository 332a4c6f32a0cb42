#include "sim/preparation.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include "core/heartbeat.h"
#include "core/log.h"
#include "sim/memory_needs.h"
#include "sim/parameters.h"
#include "sim/simulation.h"
#include "sim/statistics.h"

namespace spherule::sim {

Result<SceneAndState> withInitialState(scene::Scene scene) {
    const auto room = claimForState(scene);
    if (!room) return tl::unexpected(room.error());
    State state = stateOf(scene);
    return SceneAndState{std::move(scene), std::move(state)};
}

Preparation::Preparation(compute::Device& device, SceneAndState built, memory::Claim copies)
    : device_(device), copies_(std::move(copies)), stage_(Stage::Planning), built_(std::move(built)) {}

Preparation::Preparation(compute::Device& device, Build build, memory::Claim copies)
    : device_(device), copies_(std::move(copies)) {
    std::packaged_task<Result<SceneAndState>()> task([this, build = std::move(build)]() -> Result<SceneAndState> {
        try {
            return build(progress_);
        } catch (const std::bad_alloc&) {
            return fail(ErrorKind::Refused, "", "there is not enough memory for this", Cause::NoMemory);
        } catch (const std::exception& error) {
            return fail(ErrorKind::Refused, "", error.what());
        }
    });
    building_ = task.get_future();
    builder_ = std::jthread(std::move(task));
}

Preparation::Preparation(compute::Device& device, Build build, memory::Claim copies, Simulation& addsTo)
    : Preparation(device, std::move(build), std::move(copies)) {
    addsTo_ = &addsTo;
}

Preparation::Preparation(scene::Scene changed, memory::Claim copies, Simulation& continues, ObstacleEdit edit)
    : device_(continues.device_),
      copies_(std::move(copies)),
      stage_(Stage::Planning),
      built_{std::move(changed), {}},
      continues_(&continues),
      edit_(std::move(edit)) {}

Preparation::Preparation(scene::Scene changed, memory::Claim copies, Simulation& continues, ChangePart change)
    : device_(continues.device_),
      copies_(std::move(copies)),
      stage_(Stage::Planning),
      built_{std::move(changed), {}},
      continues_(&continues),
      change_(std::move(change)) {}

Preparation::~Preparation() {
    progress_.cancel();
}

Result<bool> Preparation::advance(std::chrono::milliseconds maxWait) {
    if (auto done = doStage(maxWait); !done) return tl::unexpected(done.error());
    return stage_ == Stage::Done;
}

Result<void> Preparation::finish() {
    constexpr std::chrono::milliseconds maxWait(10);
    for (;;) {
        const auto done = advance(maxWait);
        if (!done) return tl::unexpected(done.error());
        if (*done) return {};
    }
}

Result<void> Preparation::doStage(std::chrono::milliseconds maxWait) {
    switch (stage_) {
        case Stage::Building:
            return awaitBuilt(maxWait);
        case Stage::Planning:
            return makePlan();
        case Stage::Allocating:
            return makeNext();
        case Stage::Uploading:
            if (basis_.keepsGrid && continues_->plan().has(Array::SlotOf))
                if (auto made = pipeline_->makeSlotOf(); !made) return made;
            if (change_) return meetPresent();
            upload();
            return {};
        case Stage::MeasuringOverlaps:
            return measureOverlaps();
        case Stage::ResolvingOverlaps:
            return resolveOverlaps();
        case Stage::Done:
            return {};
    }
    return {};
}

// The waiting thread sends a heartbeat whenever the building thread has made progress.
Result<void> Preparation::awaitBuilt(std::chrono::milliseconds maxWait) {
    if (building_.wait_for(maxWait) != std::future_status::ready) {
        const Progress::Seen seen = progress_.seen();
        if (seen.marks != std::exchange(seenMarks_, seen.marks)) heartbeat::beat(seen.doing);
        return {};
    }
    auto built = building_.get();
    if (!built) return tl::unexpected(built.error());
    built_ = std::move(*built);
    stage_ = Stage::Planning;
    return {};
}

// Claims all memory before any of it is allocated.
Result<void> Preparation::makePlan() {
    progress_.at("planning", 0);
    if (addsTo_ != nullptr && addsTo_->canAppend(built_.scene)) {
        if (auto room = addsTo_->makeRoomFor(built_.state.count() - addsTo_->count()); !room) return room;
        appends_ = true;
        stage_ = Stage::Done;
        return {};
    }
    auto plan = planNow();
    if (!plan) return tl::unexpected(plan.error());
    return startPipeline(std::move(*plan), {});
}

Preparation::Basis Preparation::basis() const {
    Basis now;
    now.keepsGrid = continues_ != nullptr && (!change_ || continues_->keepsGrid(built_.scene));
    now.radii = now.keepsGrid ? continues_->radii_ : radiusStatsOf(built_.scene);
    now.features = featuresOf(built_.scene);
    if (now.keepsGrid) {
        const Plan& present = continues_->plan();
        // Spheres that are gone may have had other radii.
        if (present.features.has(Feature::Radii)) now.features.set(Feature::Radii);
        now.room = present.room;
        now.pairCapacity = present.pairCapacity;
    } else {
        now.spheres = static_cast<std::uint32_t>(built_.scene.spheres.size());
    }
    return now;
}

// Returns the plan for the present state, and keeps its basis.
Result<Plan> Preparation::planNow() {
    basis_ = basis();
    ++plans_;
    Plan plan = basis_.keepsGrid ? planAsOf(continues_->plan(), built_.scene, basis_.features, basis_.radii)
                                 : planFor(built_.scene, basis_.features, basis_.spheres, basis_.radii);
    if (plan.features.has(Feature::Contacts))
        if (auto fits = checkPeriods(built_.scene.bounds, plan.grid); !fits) return tl::unexpected(fits.error());
    return plan;
}

Result<void> Preparation::startPipeline(Plan plan, MadeKernels kernels) {
    auto claim = claimFor(device_, plan);
    if (!claim) return tl::unexpected(claim.error());
    claim_ = std::move(*claim);
    pipeline_ = std::make_unique<Pipeline>(device_, std::move(plan), std::move(kernels));
    stage_ = Stage::Allocating;
    return {};
}

Result<void> Preparation::makeNext() {
    progress_.at("making arrays and kernels", pipeline_->shareMade());
    const auto more = pipeline_->makeNext();
    if (!more) return tl::unexpected(more.error());
    if (*more) return {};
    if (!built_.scene.emitters.empty())
        if (auto made = pipeline_->makeBirths(); !made) return made;
    // The arrays are allocated now, no longer promised.
    const Plan& plan = pipeline_->plan();
    const MemoryNeeds need = memoryNeedsOf(plan);
    const std::uint64_t alreadyHeld = std::uint64_t{plan.spheres} * sizeof(scene::Sphere);
    claim_.settle(arraysOnHost(device_, plan), need.onHost() - alreadyHeld + need.temporary);
    stage_ = Stage::Uploading;
    return {};
}

void Preparation::upload() {
    progress_.at("uploading", 0);
    if (continues_ != nullptr) {
        stage_ = Stage::Done;  // continueWith() copies the arrays
        return;
    }
    for (glm::vec4& velocity : built_.state.velocity) velocity.w = std::abs(velocity.w);
    pipeline_->upload(built_.state, materialsOf(built_.scene));
    writeConstants(*pipeline_, built_.scene);
    pipeline_->setParameters(parametersFor(built_.scene, pipeline_->plan(), basis_.radii,
                                           built_.scene.step / built_.scene.quality.substeps));
    maxOverlap_ = maxSafeOverlap(built_.scene);
    stage_ = std::isfinite(maxOverlap_) ? Stage::MeasuringOverlaps : Stage::Done;
}

// Carries out the change on the scene as it is now. All that decides the next bits follows from the present state: the
// same command gives the same bits if it is carried out here at once.
Result<void> Preparation::meetPresent() {
    if (auto finite = continues_->checkFinite(); !finite) return finite;
    scene::Scene now = continues_->scene_;
    now.time = continues_->time();
    auto made = change_->make(now);
    if (!made) {
        made.error().kind = ErrorKind::Refused;
        return tl::unexpected(made.error());
    }
    made_ = *made;
    built_.scene = std::move(now);
    if (continues_->keepsKernels(built_.scene)) {
        pipeline_.reset();
        claim_ = {};
        stage_ = Stage::Done;
        return {};
    }
    if (!(basis() == basis_)) return planAgain();
    if (!basis_.keepsGrid) {
        auto state = continues_->liveState();
        if (!state) return tl::unexpected(state.error());
        built_.state = std::move(*state);
    }
    stage_ = Stage::Done;
    return {};
}

// Makes another plan, because the spheres are others by now. The simulation stands still if only the arrays are made
// again, or if it has stepped beside two plans.
Result<void> Preparation::planAgain() {
    constexpr unsigned mostBeside = 2;
    auto plan = planNow();
    if (!plan) return tl::unexpected(plan.error());
    const bool sameKernels = plan->features == pipeline_->plan().features;
    holds_ = sameKernels || plans_ > mostBeside;
    MadeKernels kernels;
    if (sameKernels) kernels = pipeline_->takeKernels();
    // The device frees the arrays before others are made.
    pipeline_.reset();
    device_.finish();
    claim_ = {};
    return startPipeline(std::move(*plan), std::move(kernels));
}

// Measures the deepest overlap: spheres that begin deep in each other would fly apart.
Result<void> Preparation::measureOverlaps() {
    progress_.at("looking for overlaps", 0);
    const double deepest = measure(*pipeline_, built_.scene).deepest();
    stage_ = Stage::Done;
    if (!(deepest > maxOverlap_)) return {};
    spdlog::info("spheres are in each other by up to {:.2g} radii; pushing them apart first", deepest);
    resolvedOverlaps_ = ResolvedOverlaps{.before = deepest};
    resolver_ = std::make_unique<InitialOverlapResolver>(device_, built_.scene, built_.state, maxOverlap_);
    stage_ = Stage::ResolvingOverlaps;
    return {};
}

Result<void> Preparation::resolveOverlaps() {
    progress_.at("pushing spheres apart", resolver_->share());
    const auto done = resolver_->advance();
    if (!done) return tl::unexpected(done.error());
    if (!*done) return {};
    resolvedOverlaps_->after = resolver_->overlap();
    resolvedOverlaps_->sweeps = resolver_->sweeps();
    State moved = resolver_->takeState();
    built_.state.position = std::move(moved.position);
    built_.state.images = std::move(moved.images);
    resolver_.reset();
    pipeline_->upload(built_.state, materialsOf(built_.scene));
    stage_ = Stage::Done;
    return {};
}

}  // namespace spherule::sim
