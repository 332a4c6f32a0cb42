#include "diagnostics/substep_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spherule::diagnostics {

namespace {

constexpr double readEvery = 0.25;  // s simulated, so that runs with a goal for the overlap are reproducible
constexpr double slowMs = 500;      // fewSteps are enough if they take this long
constexpr int fewSteps = 3;

}  // namespace

bool SubstepController::full(const scene::Scene& scene) const {
    if (steps_ >= std::max(1L, std::lround(readEvery / scene.step))) return true;
    return scene.quality.goal->kind == scene::QualityGoal::Kind::StepTime && steps_ >= fewSteps && ms_ >= slowMs;
}

Result<std::optional<std::string>> SubstepController::stepped(sim::Simulation& simulation, double wallMs) {
    const scene::Scene& scene = simulation.scene();
    if (!scene.quality.goal) return std::nullopt;
    ++steps_;
    ms_ += wallMs;
    const std::uint32_t substeps = scene.quality.substeps;
    raised_ = raised_ || simulation.substeps() != substeps;
    if (!full(scene)) return std::nullopt;
    Reading reading{.stepMs = ms_ / steps_};
    // A measurement of raised substeps does not apply to the scene's own substeps.
    const bool raised = std::exchange(raised_, false);
    steps_ = 0;
    ms_ = 0;
    if (raised) return std::nullopt;
    if (scene.quality.goal->kind == scene::QualityGoal::Kind::Overlap) {
        const sim::Statistics statistics = simulation.statistics();
        reading.contacts = statistics.contacts;
        reading.overlapMean = statistics.overlapMean;
    }
    if (!quality_) quality_.emplace(*scene.quality.goal, scene::substepRange(scene, scene.quality.model));
    auto decision = quality_->take(reading, substeps);
    if (!decision) return std::nullopt;
    if (decision->substeps != substeps)
        if (auto done = simulation.chooseSubsteps(decision->substeps); !done) return tl::unexpected(done.error());
    return std::move(decision->text);
}

}  // namespace spherule::diagnostics
