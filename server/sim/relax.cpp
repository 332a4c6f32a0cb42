#include "sim/relax.h"

#include <cmath>
#include <limits>
#include <utility>

#include "scene/stiffness.h"
#include "sim/preparation.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

constexpr std::uint32_t mostSweeps = 1024;
constexpr std::uint32_t sweepsPerLook = 16;

// Uses the model `fast`, because its pushes add no velocity.
scene::Scene withoutForces(const scene::Scene& scene) {
    scene::Scene still = scene;
    still.gravity = {};
    still.sleep.enabled = false;
    still.step = 1.0 / 480;
    still.quality = {.model = scene::Model::Fast, .substeps = 1, .pinned = true};
    still.pairs.clear();
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

double deepestBearable(const scene::Scene& scene) {
    constexpr double shallow = 0.25;  // reached in squeezed beds, exceeded by spheres placed in each other
    if (scene.quality.model == scene::Model::Fast) return std::numeric_limits<double>::infinity();
    if (scene.quality.model == scene::Model::Balanced) return shallow;
    return scene::contactTimeOf(scene).overlap;
}

Relaxation::Relaxation(compute::Device& device, const scene::Scene& scene, const State& state, double most)
    : most_(most), preparation_(std::make_unique<Preparation>(device, Built{withoutForces(scene), atRest(state)})) {}

Relaxation::~Relaxation() = default;

Result<bool> Relaxation::advance() {
    if (preparation_) {
        const auto done = preparation_->advance();
        if (!done) return tl::unexpected(done.error());
        if (*done) world_ = Simulation::from(std::exchange(preparation_, nullptr));
        return false;
    }
    if (sweeps_ == 0 || sweeps_ % sweepsPerLook != 0 || looked_) {
        looked_ = false;
        if (auto done = world_->step(); !done) return tl::unexpected(done.error());
        ++sweeps_;
        return false;
    }
    looked_ = true;
    overlap_ = world_->statistics().deepest();
    return !(overlap_ > most_) || sweeps_ >= mostSweeps;
}

double Relaxation::share() const {
    return static_cast<double>(sweeps_) / mostSweeps;
}

std::vector<glm::vec4> Relaxation::takePositions() {
    return world_->snapshot().position;
}

}  // namespace spherule::sim
