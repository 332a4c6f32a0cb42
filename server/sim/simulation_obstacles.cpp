// The part of Simulation for obstacles that move, or that are added, moved and removed by command.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scene/load.h"
#include "scene/obstacle_changes.h"
#include "scene/quality.h"
#include "scene/shapes.h"
#include "sim/memory_needs.h"
#include "sim/mesh_tables.h"
#include "sim/parameters.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

Error refused(Error error) {
    error.kind = ErrorKind::Refused;
    return error;
}

// Returns the new number of each surface of `before`; nullopt if it is gone. `changed`: the number of the obstacle that
// was replaced or removed; behind the last one if there is none.
std::vector<std::optional<std::uint32_t>> newSurfaces(const scene::Scene& before, const scene::Scene& after,
                                                      std::size_t changed) {
    std::vector<std::optional<std::uint32_t>> surfaces;
    for (std::uint32_t face = 0; face < scene::faceCount; ++face) surfaces.emplace_back(face);
    const bool removed = after.obstacles.size() < before.obstacles.size();
    std::uint32_t next = scene::faceCount;
    for (std::size_t k = 0; k < before.obstacles.size(); ++k) {
        const std::uint32_t parts = before.obstacles[k].shape->parts();
        const bool gone = removed && k == changed;
        for (std::uint32_t part = 0; part < parts; ++part)
            surfaces.push_back(gone ? std::nullopt : std::optional(next + part));
        if (!gone) next += parts;
    }
    return surfaces;
}

// Gives the driven bodies of `after` their present states. `changed`: the number of the obstacle that was added,
// replaced or removed.
void continueDrives(const std::vector<scene::Obstacle>& before, std::vector<scene::Obstacle>& after,
                    std::size_t changed) {
    const bool removed = after.size() < before.size();
    for (std::size_t k = 0; k < before.size(); ++k) {
        if (k == changed || !before[k].motion || !before[k].motion->drive) continue;
        after[k - (removed && k > changed ? 1 : 0)].motion->drive = before[k].motion->drive;
    }
}

}  // namespace

// Returns the substep that is next, in s simulated.
TimeSpan Simulation::nextSubstep() const {
    const double begin = time();
    const double length =
        substepsLeft_ > 0 ? (1 - remainderBegin_) * scene_.step / remainderSubsteps_ : scene_.step / substeps_;
    return {begin, begin + length};
}

// Uploads where obstacles that move are at a time, and their motion in the next substep.
void Simulation::placeObstacles(double framesAt) {
    if (!obstacleRows_->anyMoves()) return;
    obstacleRows_->place(scene_, nextSubstep(), framesAt);
    obstacleRows_->upload(*pipeline_);
}

Result<Simulation::Outcome> Simulation::changeObstacle(const ChangeObstacle& change) {
    scene::Scene changed = scene_;
    changed.time = time();
    std::vector<scene::Obstacle>& obstacles = changed.obstacles;
    const std::size_t number = change.obstacle.value_or(static_cast<std::uint32_t>(obstacles.size()));
    if (change.obstacle && number >= obstacles.size())
        return fail(ErrorKind::Refused, "obstacle",
                    obstacles.empty() ? "is not there: the scene has no obstacles"
                                      : fmt::format("is {}, must be 0 to {}", number, obstacles.size() - 1),
                    Cause::Range);
    auto made = change.make(changed);
    if (!made) return tl::unexpected(refused(made.error()));
    auto copies = memory::Claim::make("", "a change of the obstacles", copiesToChange(plan()));
    if (!copies) return tl::unexpected(copies.error());
    const scene::Obstacle* const before = change.obstacle ? &scene_.obstacles[number] : nullptr;
    Preparation::ObstacleEdit edit{.number = static_cast<std::uint32_t>(number)};
    if (before != nullptr) edit.places.push_back(*before);
    if (*made) {
        edit.places.push_back(**made);
        const auto state = liveState();
        if (!state) return tl::unexpected(state.error());
        if (auto free = checkWay(**made, before, *state); !free) return tl::unexpected(free.error());
        if (before != nullptr)
            obstacles[number] = std::move(**made);
        else
            obstacles.push_back(std::move(**made));
    } else {
        obstacles.erase(obstacles.begin() + static_cast<std::ptrdiff_t>(number));
    }
    if (auto fits = scene::checkObstacles(changed); !fits) return tl::unexpected(refused(fits.error()));
    if (auto fits = scene::checkModel(changed); !fits) return tl::unexpected(refused(fits.error()));
    if (auto fits = scene::fitSubsteps(changed); !fits) return tl::unexpected(refused(fits.error()));
    edit.surfaces = newSurfaces(scene_, changed, number);
    return Outcome{.preparation =
                       std::make_unique<Preparation>(std::move(changed), std::move(*copies), *this, std::move(edit))};
}

// Refuses an obstacle that spheres are in the way of. Pressed spheres overlap a little; a sphere that was as deep in
// the obstacle before it moved may stay.
Result<void> Simulation::checkWay(const scene::Obstacle& obstacle, const scene::Obstacle* before,
                                  const State& state) const {
    constexpr double allowed = 0.05;  // of the radius
    const glm::dvec3 centre = scene_.bounds.centre();
    const scene::Frame moved = obstacle.movedBy(time());
    std::uint32_t inWay = 0;
    std::uint64_t first = 0;
    for (std::uint32_t rank = 0; rank < state.count(); ++rank) {
        const glm::dvec3 x = positionOf(state, rank) + centre;
        const double r = radiusOf(state, rank);
        const double depth = r - obstacle.shape->distance(moved.inside(x));
        if (!(depth > allowed * r)) continue;
        if (before != nullptr && depth <= r - before->distance(x, time())) continue;
        if (inWay++ == 0) first = population_.idAt(rank);
    }
    if (inWay == 0) return {};
    return fail(ErrorKind::Refused, "obstacle",
                inWay == 1
                    ? fmt::format("would be where sphere {} is; remove the sphere, or choose another place", first)
                    : fmt::format("would be where {} spheres are, the first is {}; remove them, or choose another "
                                  "place",
                                  inWay, first),
                Cause::NoRoom, {.least = {}, .most = 0});
}

// Takes other obstacles, with the spheres as they are. Cannot fail.
void Simulation::continueWith(Preparation& preparation) {
    closeContactSums();
    const auto before = plan().meshes;
    const auto after = preparation.pipeline_->plan().meshes;
    const Preparation::ObstacleEdit& edit = preparation.edit_;
    const bool removed = preparation.built_.scene.obstacles.size() < scene_.obstacles.size();
    preparation.pipeline_->takeFrom(*pipeline_, [&](std::uint32_t key) -> std::optional<std::uint32_t> {
        if (key < edit.surfaces.size()) return edit.surfaces[key];
        for (std::size_t k = 0; before && after && k < before->rows.size(); ++k) {
            if (key >= before->rows[k].endKey) continue;
            if (removed && k == edit.number) return std::nullopt;
            const std::size_t now = k - (removed && k > edit.number ? 1 : 0);
            return after->rows[now].firstKey + (key - before->rows[k].firstKey);
        }
        return std::nullopt;
    });
    pipeline_ = std::move(preparation.pipeline_);
    wakeAt(preparation.edit_.places);
    continueDrives(scene_.obstacles, preparation.built_.scene.obstacles, edit.number);
    scene_ = std::move(preparation.built_.scene);
    writeConstants(*pipeline_, scene_);
    claim_ = std::move(preparation.claim_);
    settleClaim(claim_, device_, plan());
    obstacleRows_.emplace(scene_, plan().meshes.get());
    drives_.emplace(scene_, plan());
    maxSubsteps_ = scene::maxRaisedSubsteps(scene_);
    useSubsteps(std::max(substeps_, scene_.quality.substeps));
    contactSums_.loads.clear();  // surfaces have other numbers
    openContactSums();
    limitMotionPerSubstep(motionOfObstacles());
    ++generation_;
}

// Wakes the spheres that touch one of the obstacles, or nearly so.
void Simulation::wakeAt(const std::vector<scene::Obstacle>& obstacles) {
    if (!plan().features.has(Feature::Sleep)) return;
    const State state = snapshot();
    const glm::dvec3 centre = scene_.bounds.centre();
    const double gap = static_cast<double>(plan().grid.margin);
    std::vector<scene::Frame> moved;
    for (const scene::Obstacle& one : obstacles) moved.push_back(one.movedBy(time()));
    std::vector<std::uint32_t> handles;
    for (std::uint32_t rank = 0; rank < state.count(); ++rank) {
        const glm::dvec3 x = positionOf(state, rank) + centre;
        const double reach = radiusOf(state, rank) + gap;
        for (std::size_t k = 0; k < obstacles.size(); ++k)
            if (obstacles[k].shape->distance(moved[k].inside(x)) < reach) {
                handles.push_back(population_.handleAt(rank));
                break;
            }
    }
    pipeline_->wake(handles);
}

}  // namespace spherule::sim
