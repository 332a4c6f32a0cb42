#include "sim/obstacle_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "sim/mesh_tables.h"

namespace spherule::sim {

namespace {

void setFrame(layout::Obstacle& row, const scene::Frame& frame) {
    const auto axis = [&](int k) { return glm::vec4(glm::dvec4(frame.turn[k], frame.origin[k])); };
    row.frameX = axis(0);
    row.frameY = axis(1);
    row.frameZ = axis(2);
    row.framed = 1;
}

// Returns the axis of the rotation, of the length of the tangent of half its angle.
glm::dvec3 cayleyVector(const glm::dquat& turn) {
    return glm::dvec3(turn.x, turn.y, turn.z) / turn.w;
}

// Returns the rate of a driven body at the end of `times`, over its largest one, if no sphere touches it.
double shareOfMostRate(const scene::Motion& motion, const scene::Scene& scene, const TimeSpan& times) {
    const scene::Drive& drive = *motion.drive;
    const double gained = std::abs(drive.forceAt(scene.forces.gravity, motion.pivot)) / drive.inertia;
    return std::min((std::abs(drive.rate) + gained * (times.end - times.begin)) / drive.mostRate, 1.0);
}

}  // namespace

ObstacleRows::ObstacleRows(const scene::Scene& scene, const MeshTables* meshes) : centre_(scene.bounds.centre()) {
    std::uint32_t surface = scene::faceCount;
    std::uint32_t drive = scene::surfacesOf(scene);
    for (const scene::Obstacle& obstacle : scene.obstacles) {
        // A body that moves lies in a frame about its pivot.
        const glm::dvec3 origin = obstacle.motion ? obstacle.motion->pivot : centre_;
        const scene::Shape::Row row = obstacle.shape->row(origin);
        layout::Obstacle to{};
        to.a = row.a;
        to.b = row.b;
        if (obstacle.shape->kind() == scene::ShapeKind::Meshes) {
            const MeshTables::Row& mesh = meshes->rows[rows_.size()];
            to.a = mesh.a;
            to.b = mesh.b;
            to.cellsAt = mesh.cellsAt;
            to.nodesAt = mesh.nodesAt;
        }
        to.shape = static_cast<std::uint32_t>(obstacle.shape->kind());
        to.parts = obstacle.shape->parts();
        to.surface = surface;
        to.material = obstacle.material;
        if (row.frame) setFrame(to, *row.frame);
        if (obstacle.motion) {
            Moving moving{rows_.size(), row.frame.value_or(scene::Frame()), obstacle.largestSpeed(scene.bounds)};
            if (obstacle.motion->drive) moving.drive = std::exchange(drive, drive + DRIVE_SUM_ROWS);
            moving_.push_back(moving);
        }
        rows_.push_back(to);
        surface += to.parts;
    }
    rows_.resize(rows_.size() + moving_.size());
    place(scene, {scene.time, scene.time}, scene.time);
}

void ObstacleRows::place(const scene::Scene& scene, const TimeSpan& times, double framesAt) {
    const std::size_t first = rows_.size() - moving_.size();
    for (std::size_t k = 0; k < moving_.size(); ++k) {
        layout::Obstacle& row = rows_[moving_[k].obstacle];
        layout::Obstacle& motion = rows_[first + k];
        const scene::Motion& moves = *scene.obstacles[moving_[k].obstacle].motion;
        const scene::Pose from = moves.poseAt(times.begin);
        const scene::Pose to = moves.poseAt(times.end);
        const scene::Pose& at = framesAt == times.begin ? from : to;
        const glm::dvec3 pivot = at.pivot + at.shift - centre_;
        const glm::dmat3 turn = glm::mat3_cast(at.turn);
        setFrame(row, {turn * moving_[k].local.turn, pivot + turn * moving_[k].local.origin});
        const bool runs = moves.runsBetween(times.begin, times.end);
        row.motion = runs ? static_cast<std::uint32_t>(first + k) : 0U;
        motion.a = glm::vec4(glm::dvec4(pivot, 0));
        motion.b = glm::vec4(glm::dvec4(to.shift - from.shift, 0));
        motion.frameX = glm::vec4(glm::dvec4(cayleyVector(to.turn * glm::conjugate(from.turn)), 0));
        motion.frameY = glm::vec4(glm::dvec4(at.turn * moves.belt, 0));
        if (!moves.drive) continue;
        motion.frameZ = glm::vec4(glm::dvec4(moves.drive->axis, 1 / moves.drive->inertia));
        motion.shape = moves.drive->turns ? DRIVE_TURNS : DRIVE_SLIDES;
        motion.surface = moving_[k].drive;
    }
}

double ObstacleRows::fastestIn(const scene::Scene& scene, const TimeSpan& times) const {
    double fastest = 0;
    for (const Moving& moving : moving_) {
        const scene::Motion& motion = *scene.obstacles[moving.obstacle].motion;
        if (motion.drive)
            fastest = std::max(fastest, moving.largestSpeed * shareOfMostRate(motion, scene, times));
        else if (motion.runsBetween(times.begin, times.end))
            fastest = std::max(fastest, moving.largestSpeed);
    }
    return fastest;
}

void ObstacleRows::upload(Pipeline& pipeline) const {
    const std::size_t first = moving_.front().obstacle;
    pipeline.write<layout::Obstacle>(Array::Obstacles, std::span(rows_).subspan(first), first);
}

}  // namespace spherule::sim
