#include "sim/drives.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include <glm/geometric.hpp>

#include "scene/shapes.h"

namespace spherule::sim {

namespace {

scene::Drive& driveOf(scene::Scene& scene, std::size_t obstacle) {
    return *scene.obstacles[obstacle].motion->drive;
}

// Returns the rate after a substep of `h` seconds, by `force` (N or N m) and an impulse (N s or N m s).
double rateAfter(const scene::Drive& drive, double rate, double force, double impulse, double h) {
    const double after = (drive.inertia * rate + h * force + impulse) / (drive.inertia + h * drive.damping);
    return std::clamp(after, -drive.mostRate, drive.mostRate);
}

// Returns the rate at which it does not pass its stops in `h` seconds.
double rateWithinStops(const scene::Drive& drive, double rate, double h) {
    return std::clamp(rate, (drive.least - drive.place) / h, (drive.most - drive.place) / h);
}

// Returns the impulse that spheres give the body along its axis (N s), or about it (N m s).
double impulseOn(const scene::Drive& drive, const SurfaceLoad& load, const glm::dvec3& pivot) {
    if (!drive.turns) return glm::dot(drive.axis, load.impulse);
    return glm::dot(drive.axis, load.moment - glm::cross(pivot, load.impulse));
}

}  // namespace

std::size_t driveSumWords(const scene::Scene& scene) {
    const auto driven = std::ranges::count_if(
        scene.obstacles, [](const scene::Obstacle& one) { return one.motion && one.motion->drive; });
    return static_cast<std::size_t>(driven) * DRIVE_SUM_ROWS * surfaceSumWords;
}

Drives::Drives(const scene::Scene& scene, const Plan& plan)
    : balanced_(plan.features.has(Feature::Balanced)),
      firstWord_(std::size_t{scene::surfacesOf(scene)} * surfaceSumWords),
      words_(driveSumWords(scene)) {
    for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
        if (scene.obstacles[k].motion && scene.obstacles[k].motion->drive) bodies_.push_back({.obstacle = k});
}

void Drives::startAt(scene::Scene& scene, double time) const {
    for (const Body& body : bodies_) driveOf(scene, body.obstacle).since = time;
}

void Drives::predict(scene::Scene& scene, const TimeSpan& substep) {
    const double h = substep.end - substep.begin;
    for (Body& body : bodies_) {
        scene::Drive& drive = driveOf(scene, body.obstacle);
        drive.since = substep.begin;
        body.rate = drive.rate;
        if (balanced_) {
            const double force = drive.forceAt(scene.forces.gravity, scene.obstacles[body.obstacle].motion->pivot);
            const double held = body.heldFor > 0 ? body.held * (h / body.heldFor) : 0;
            drive.rate = rateAfter(drive, body.rate, force, held, h);
        }
        drive.rate = rateWithinStops(drive, drive.rate, h);
    }
}

void Drives::advance(scene::Scene& scene, const TimeSpan& substep, Pipeline& pipeline, const LoadUnits& units) {
    const double h = substep.end - substep.begin;
    pipeline.readInto(words_, Array::SurfaceSums, words_.size(), firstWord_);
    const std::size_t rows = std::size_t{DRIVE_SUM_ROWS} * surfaceSumWords;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        Body& body = bodies_[k];
        scene::Drive& drive = driveOf(scene, body.obstacle);
        const auto loadIn = [&](std::size_t row) {
            return surfaceLoadIn(std::span(words_).subspan(k * rows + row * surfaceSumWords, surfaceSumWords), units);
        };
        const glm::dvec3 pivot = scene.obstacles[body.obstacle].motion->pivot;
        const glm::dvec3 arm = pivot - scene.bounds.centre();
        const double got = impulseOn(drive, loadIn(0), arm);
        const double force = drive.forceAt(scene.forces.gravity, pivot);
        const double after = rateAfter(drive, body.rate, force, got, h);
        if (balanced_) {
            drive.rate = rateWithinStops(drive, after, h);
            body.held = impulseOn(drive, loadIn(1), arm);
            body.heldFor = h;
        }
        drive.place = std::clamp(drive.place + h * drive.rate, drive.least, drive.most);
        if (!balanced_) drive.rate = after;
        if (drive.place == drive.least) drive.rate = std::max(drive.rate, 0.0);
        if (drive.place == drive.most) drive.rate = std::min(drive.rate, 0.0);
        drive.since = substep.end;
    }
    std::ranges::fill(words_, 0U);
    pipeline.write<std::uint32_t>(Array::SurfaceSums, words_, firstWord_);
}

std::vector<scene::Drive> Drives::states(const scene::Scene& scene) const {
    std::vector<scene::Drive> states;
    for (const Body& body : bodies_) states.push_back(*scene.obstacles[body.obstacle].motion->drive);
    return states;
}

void Drives::restore(scene::Scene& scene, const std::vector<scene::Drive>& states, double time) {
    for (std::size_t k = 0; k < bodies_.size() && states.size() == bodies_.size(); ++k) {
        scene::Drive& drive = driveOf(scene, bodies_[k].obstacle);
        drive.place = std::clamp(states[k].place, drive.least, drive.most);
        drive.rate = std::clamp(states[k].rate, -drive.mostRate, drive.mostRate);
        bodies_[k].held = 0;
    }
    startAt(scene, time);
}

}  // namespace spherule::sim
