#include "sim/initial_overlaps.h"

#include <cmath>
#include <limits>
#include <utility>

#include "scene/stiffness.h"
#include "sim/preparation.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

constexpr std::uint32_t maxSweeps = 1024;
constexpr std::uint32_t sweepsPerCheck = 16;

// Uses the model `fast`, because its pushes add no velocity.
scene::Scene withoutForces(const scene::Scene& scene) {
    scene::Scene still = scene;
    still.forces = {};
    still.sleep.enabled = false;
    still.step = 1.0 / 480;
    still.quality = {.model = scene::Model::Fast, .substeps = 1, .substepsFixed = true};
    still.pairs.clear();
    still.sinks.clear();
    for (scene::Material& material : still.materials)
        material = {.name = material.name, .density = material.density, .restitution = 0};
    return still;
}

State atRest(State state) {
    for (glm::vec4& velocity : state.velocity) velocity = glm::vec4(0, 0, 0, std::abs(velocity.w));
    for (glm::vec4& spin : state.spin) spin = {};
    return state;
}

}  // namespace

double maxSafeOverlap(const scene::Scene& scene) {
    constexpr double shallow = 0.25;  // reached in squeezed beds, exceeded by spheres placed in each other
    if (scene.quality.model == scene::Model::Fast) return std::numeric_limits<double>::infinity();
    if (scene.quality.model == scene::Model::Balanced) return shallow;
    return scene::contactTimeOf(scene).overlap;
}

InitialOverlapResolver::InitialOverlapResolver(compute::Device& device, const scene::Scene& scene, const State& state,
                                               double maxOverlap)
    : maxOverlap_(maxOverlap),
      preparation_(std::make_unique<Preparation>(device, SceneAndState{withoutForces(scene), atRest(state)})) {}

InitialOverlapResolver::~InitialOverlapResolver() = default;

Result<bool> InitialOverlapResolver::advance() {
    if (preparation_) {
        const auto done = preparation_->advance();
        if (!done) return tl::unexpected(done.error());
        if (*done) simulation_ = Simulation::from(std::exchange(preparation_, nullptr));
        return false;
    }
    if (sweeps_ == 0 || sweeps_ % sweepsPerCheck != 0 || measured_) {
        measured_ = false;
        if (auto done = simulation_->step(); !done) return tl::unexpected(done.error());
        ++sweeps_;
        return false;
    }
    measured_ = true;
    overlap_ = simulation_->statistics().deepest();
    return !(overlap_ > maxOverlap_) || sweeps_ >= maxSweeps;
}

double InitialOverlapResolver::share() const {
    return static_cast<double>(sweeps_) / maxSweeps;
}

State InitialOverlapResolver::takeState() {
    return simulation_->snapshot();
}

}  // namespace spherule::sim
