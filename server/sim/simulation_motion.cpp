// The part of Simulation that keeps spheres and obstacles from moving too far in a substep.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

static_assert(scene::safeMotion == static_cast<double>(SAFE_MOTION));

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
double largestMotion(const scene::Scene& scene, const State& state, double h) {
    double farthest = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const double speed = glm::length(glm::dvec3(state.velocity[id]));
        const glm::dvec3 place = scene.bounds.centre() + positionOf(state, id);
        const scene::Body body{.radius = radiusOf(state, id), .mass = massOf(state, id)};
        const double acceleration = glm::length(scene.forces.accelerationAt(place, body));
        const double lookAhead = 2 * scene.step * (speed + 2 * scene.step * acceleration);
        if (beyond(scene.bounds, positionOf(state, id)) > lookAhead + radiusOf(state, id)) continue;
        farthest = std::max(farthest, speed * h / static_cast<double>(state.position[id].w));
    }
    return farthest;
}

}  // namespace

// Raises the number of substeps if one of these spheres moves too far in a substep.
void Simulation::limitMotionOf(const State& state) {
    limitMotionPerSubstep(std::max(largestMotion(scene_, state, scene_.step / substeps_), motionOfObstacles()));
}

// Raises the number of substeps at once when the fastest sphere has moved too far in a substep, and gives notice only
// if the most substeps are too few. Lowers it gradually when no sphere does. After each reduction that was too early,
// waits longer before the next.
void Simulation::limitMotionPerSubstep(double radiiPerSubstep) {
    constexpr double reduction = 0.8;
    constexpr std::uint32_t maxBackoff = 256;  // steps
    const std::uint32_t requested = scene_.quality.substeps;
    const double most = std::max(substeps_, maxSubsteps_);
    std::uint32_t target = substeps_;
    bool withinLimit = true;
    ++quietSteps_;
    if (radiiPerSubstep > static_cast<double>(SAFE_MOTION)) {
        const double needed = std::ceil(substeps_ * radiiPerSubstep / static_cast<double>(SAFE_MOTION));
        withinLimit = needed <= most;
        target = static_cast<std::uint32_t>(std::min(needed, most));
        if (quietSteps_ > 2 * maxBackoff) backoff_ = 0;
        if (lowered_) backoff_ = std::clamp(2 * backoff_, 4U, maxBackoff);
        lowered_ = false;
        quietSteps_ = 0;
    } else if (substeps_ > requested && quietSteps_ > backoff_) {
        target = std::max(requested, static_cast<std::uint32_t>(reduction * substeps_));
        lowered_ = true;
    }
    if (withinLimit && target == requested) tooFast_ = false;
    if (!withinLimit && !std::exchange(tooFast_, true))
        notices_.push_back(fmt::format(
            "at step {}, a sphere moves {:.2g} radii in a substep: even with {} substeps per step in place of {}, "
            "it may pass through what it should hit",
            steps_, radiiPerSubstep, target, requested));
    if (target != substeps_) useSubsteps(target);
}

// Returns the largest motion of an obstacle in a substep of the next step, in radii of the smallest sphere.
double Simulation::motionOfObstacles() const {
    const double fastest = obstacleRows_->fastestIn(scene_, {time(), time() + scene_.step});
    return fastest > 0 ? fastest * scene_.step / substeps_ / radii_.smallest : 0;
}

}  // namespace spherule::sim
