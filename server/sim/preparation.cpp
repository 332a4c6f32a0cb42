#include "sim/preparation.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include "core/heartbeat.h"
#include "core/log.h"
#include "sim/need.h"
#include "sim/parameters.h"
#include "sim/statistics.h"

namespace spherule::sim {

Result<Built> builtOf(scene::Scene scene) {
    const auto room = claimForState(scene.spheres.size());
    if (!room) return tl::unexpected(room.error());
    State state = stateOf(scene);
    return Built{std::move(scene), std::move(state)};
}

Preparation::Preparation(compute::Device& device, Built built, memory::Claim copies)
    : device_(device), copies_(std::move(copies)), stage_(Stage::Planning), built_(std::move(built)) {}

Preparation::Preparation(compute::Device& device, Build build, memory::Claim copies)
    : device_(device), copies_(std::move(copies)) {
    std::packaged_task<Result<Built>()> task([this, build = std::move(build)]() -> Result<Built> {
        try {
            return build(progress_);
        } catch (const std::bad_alloc&) {
            return fail(ErrorKind::Refused, "", "there is not enough memory for this");
        } catch (const std::exception& error) {
            return fail(ErrorKind::Refused, "", error.what());
        }
    });
    building_ = task.get_future();
    builder_ = std::jthread(std::move(task));
}

Preparation::~Preparation() {
    progress_.cancel();
}

Result<bool> Preparation::advance(std::chrono::milliseconds patience) {
    if (auto done = doStage(patience); !done) return tl::unexpected(done.error());
    return stage_ == Stage::Done;
}

Result<void> Preparation::finish() {
    constexpr std::chrono::milliseconds patience(10);
    for (;;) {
        const auto done = advance(patience);
        if (!done) return tl::unexpected(done.error());
        if (*done) return {};
    }
}

Result<void> Preparation::doStage(std::chrono::milliseconds patience) {
    switch (stage_) {
        case Stage::Building:
            return awaitBuilt(patience);
        case Stage::Planning:
            return makePlan();
        case Stage::Making:
            return makeNext();
        case Stage::Uploading:
            upload();
            return {};
        case Stage::Looking:
            return look();
        case Stage::Parting:
            return part();
        case Stage::Done:
            return {};
    }
    return {};
}

// The waiting thread sends a heartbeat whenever the building thread has made progress.
Result<void> Preparation::awaitBuilt(std::chrono::milliseconds patience) {
    if (building_.wait_for(patience) != std::future_status::ready) {
        const Progress::Seen seen = progress_.seen();
        if (seen.marks != std::exchange(marks_, seen.marks)) heartbeat::beat(seen.doing);
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
    radii_ = radiiOf(built_.scene);
    Plan plan = planFor(built_.scene, featuresOf(built_.scene), built_.state.count(), radii_);
    auto claim = claimFor(device_, plan);
    if (!claim) return tl::unexpected(claim.error());
    claim_ = std::move(*claim);
    pipeline_ = std::make_unique<Pipeline>(device_, std::move(plan));
    stage_ = Stage::Making;
    return {};
}

Result<void> Preparation::makeNext() {
    progress_.at("making arrays and kernels", pipeline_->shareMade());
    const auto more = pipeline_->makeNext();
    if (!more) return tl::unexpected(more.error());
    if (*more) return {};
    // The arrays are allocated now, no longer promised.
    const Plan& plan = pipeline_->plan();
    const Need need = needOf(plan);
    const std::uint64_t there = std::uint64_t{plan.spheres} * sizeof(scene::Sphere);
    claim_.settle(arraysOnHost(device_, plan), need.onHost() - there + need.work);
    stage_ = Stage::Uploading;
    return {};
}

void Preparation::upload() {
    progress_.at("uploading", 0);
    for (glm::vec4& velocity : built_.state.velocity) velocity.w = std::abs(velocity.w);
    pipeline_->upload(built_.state, materialsOf(built_.scene));
    writeConstants(*pipeline_, built_.scene);
    pipeline_->setParameters(
        parametersFor(built_.scene, pipeline_->plan(), radii_, built_.scene.step / built_.scene.quality.substeps));
    tolerated_ = deepestBearable(built_.scene);
    stage_ = std::isfinite(tolerated_) ? Stage::Looking : Stage::Done;
}

// Measures the deepest overlap: spheres that begin deep in each other would fly apart.
Result<void> Preparation::look() {
    progress_.at("looking for overlaps", 0);
    const double deepest = measure(*pipeline_, built_.scene).deepest();
    stage_ = Stage::Done;
    if (!(deepest > tolerated_)) return {};
    spdlog::info("spheres are in each other by up to {:.2g} radii; pushing them apart first", deepest);
    parted_ = Parted{.before = deepest};
    relaxation_ = std::make_unique<Relaxation>(device_, built_.scene, built_.state, tolerated_);
    stage_ = Stage::Parting;
    return {};
}

Result<void> Preparation::part() {
    progress_.at("pushing spheres apart", relaxation_->share());
    const auto done = relaxation_->advance();
    if (!done) return tl::unexpected(done.error());
    if (!*done) return {};
    parted_->after = relaxation_->overlap();
    parted_->sweeps = relaxation_->sweeps();
    built_.state.position = relaxation_->takePositions();
    relaxation_.reset();
    pipeline_->upload(built_.state, materialsOf(built_.scene));
    stage_ = Stage::Done;
    return {};
}

}  // namespace spherule::sim
