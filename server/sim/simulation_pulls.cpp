// The part of Simulation that pulls spheres by springs.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "sim/memory_needs.h"
#include "sim/simulation.h"
#include "sim/state.h"

namespace spherule::sim {

namespace {

constexpr double usualRate = 10;   // 1/s
constexpr double mostRate = 1000;  // 1/s

glm::dvec3 limited(const glm::dvec3& a, double most) {
    const double length = glm::length(a);
    return length > most ? a * (most / length) : a;
}

}  // namespace

// The largest speed (m/s) and acceleration (m/s^2) that a spring gives to a sphere of this radius. It never makes a
// sphere so fast that it needs more substeps, and contacts resist it: rigid ones within a substep, soft ones over many.
// A spring can always lift its sphere.
Simulation::PullLimits Simulation::pullLimits(double radius) const {
    const bool soft = scene_.quality.model == scene::Model::Accurate;
    const double perSubstep = (soft ? 1.0 / 32 : 0.9) * scene::safeMotion * radius;  // m
    const double substepsToIt = soft ? 80 : 4;
    const double substep = scene_.step / scene_.quality.substeps;
    const double speed = perSubstep / substep;
    return {.speed = speed,
            .acceleration = std::max(10 * glm::length(scene_.forces.gravity), speed / (substepsToIt * substep))};
}

Result<glm::dvec3> Simulation::pull(const Pull& pull, std::uint32_t rank) {
    const std::uint32_t handle = population_.handleAt(rank);
    const double mass = 1 / std::abs(static_cast<double>(pipeline_->velocityOf(handle).w));
    const double stiffness = pull.stiffness.value_or(mass * usualRate * usualRate);
    const double most = mass * mostRate * mostRate;
    if (!(stiffness > 0 && stiffness <= most))
        return fail(
            ErrorKind::Refused, "stiffness",
            fmt::format("is {:g} N/m, must be above 0 and at most {:g} for sphere {}", stiffness, most, pull.sphere),
            Cause::Range, {.least = 0, .most = most});
    const PullSpring spring{pull.session, pull.sphere, pull.point, stiffness};
    const auto mine = std::ranges::find(pulls_, pull.session, &PullSpring::session);
    if (mine == pulls_.end() && pulls_.size() >= MOST_PULLS)
        return fail(ErrorKind::Refused, "",
                    fmt::format("{} spheres are pulled already: wait until one is released", pulls_.size()),
                    Cause::NoRoom);
    const std::vector<PullSpring> before = pulls_;
    const bool same = mine != pulls_.end() && mine->sphere == pull.sphere;
    if (mine != pulls_.end())
        *mine = spring;
    else
        pulls_.push_back(spring);
    const std::uint64_t bytes = plan().bytes();
    if (auto done = writePulls(); !done) {
        pulls_ = before;
        return tl::unexpected(done.error());
    }
    if (plan().bytes() != bytes) settleClaim(claim_, device_, plan());
    if (!same) pipeline_->applyImpulse(handle, glm::vec3(0));  // wakes it
    return forceOf(spring, rank);
}

void Simulation::release(std::uint64_t session) {
    if (std::erase_if(pulls_, [&](const PullSpring& spring) { return spring.session == session; }) > 0) keepPulls();
}

std::vector<std::uint64_t> Simulation::pullingSessions() const {
    std::vector<std::uint64_t> sessions;
    for (const PullSpring& spring : pulls_) sessions.push_back(spring.session);
    return sessions;
}

// The square root of stiffness over mass (1/s). The mass may have fallen since the pull began.
double Simulation::rateOf(const PullSpring& spring, std::uint32_t rank) const {
    return std::min(std::sqrt(spring.stiffness / massOf(scene_, scene_.spheres[rank])), mostRate);
}

// Sends the springs to the device.
Result<void> Simulation::writePulls() {
    std::vector<glm::vec4> rows;
    for (const PullSpring& spring : pulls_) {
        const std::uint32_t rank = *population_.rankOf(spring.sphere);
        const glm::vec3 point(spring.point - scene_.bounds.centre());
        const PullLimits limits = pullLimits(static_cast<double>(scene_.spheres[rank].radius));
        rows.emplace_back(point, static_cast<float>(rateOf(spring, rank)));
        rows.emplace_back(limits.acceleration, limits.speed, population_.handleAt(rank), 0);
    }
    return pipeline_->setPulls(rows);
}

// Ends the springs of spheres that are gone, and fits the others to the present settings and arrays.
void Simulation::keepPulls() {
    std::erase_if(pulls_, [&](const PullSpring& spring) { return !population_.rankOf(spring.sphere); });
    if (const auto done = writePulls(); !done) {
        notices_.push_back(fmt::format("at step {}, all pulled spheres are released: {}", steps_, done.error().text()));
        pulls_.clear();
    }
}

// The force (N) that the spring exerts in the next substep, as in shaders/pull.comp.
glm::dvec3 Simulation::forceOf(const PullSpring& spring, std::uint32_t rank) {
    const std::uint32_t handle = population_.handleAt(rank);
    const glm::dvec4 velocity(pipeline_->velocityOf(handle));
    const glm::dvec3 place = glm::dvec3(pipeline_->positionOf(handle)) + scene_.bounds.centre();
    const double substep = scene_.step / substeps_;
    const scene::Body body = scene::bodyOf(scene_, scene_.spheres[rank]);
    const glm::dvec3 mean = glm::dvec3(velocity) + scene_.forces.accelerationAt(place, body) * (0.5 * substep);
    const glm::dvec3 path = scene::separation(spring.point, place, scene_.bounds.periods());
    const double rate = rateOf(spring, rank);
    const double share = 1 / ((1 + substep * rate) * (1 + substep * rate));
    const glm::dvec3 given = limited(path * (rate * rate * share), pullLimits(body.radius).acceleration);
    return (given - mean * ((1 - share) / substep)) / std::abs(velocity.w);
}

}  // namespace spherule::sim
