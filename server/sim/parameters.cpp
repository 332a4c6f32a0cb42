#include "sim/parameters.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace spherule::sim {

namespace {

// Lists hold until a sphere has moved this share of the margin: two may approach each other, and the position pass
// moves them a little further before the next check.
constexpr double rebuildShare = 0.45;

void setSleep(layout::Parameters& p, const scene::Scene& scene, const Plan& plan) {
    const double g = glm::length(scene.gravity);
    const double h = scene.step / scene.substeps;
    // Well above what lets a sphere fall asleep, or the two would take turns; and above what the solver's pushes make
    // of a sphere squeezed between others: up to some 15 g h in a bed 20 deep. Whoever moves away more slowly creeps.
    constexpr double kicks = 20;
    p.sleepSpeed = static_cast<float>(scene.sleep.speed);
    p.wakeSpeed = static_cast<float>(std::max(3 * scene.sleep.speed, kicks * g * h));
    // Who stays within this distance of one place for the sleep time has not crossed it faster than the sleep speed.
    const double creep =
        std::min(static_cast<double>(plan.grid.margin) / 3, 0.5 * scene.sleep.speed * scene.sleep.time);
    p.creep = static_cast<float>(creep);
    // In weak gravity, a free flight stays within that distance of its top for up to 3.4 sqrt(creep / g).
    p.sleepTime = static_cast<float>(std::max(scene.sleep.time, g > 0 ? 4 * std::sqrt(creep / g) : 0.0));
}

}  // namespace

layout::Parameters parametersFor(const scene::Scene& scene, const Plan& plan, const Radii& radii,
                                 const v1::WireGrid& wire) {
    layout::Parameters p{};
    const glm::dvec3 centre = scene.bounds.centre();
    p.gravity = glm::vec4(glm::vec3(scene.gravity), 0);
    p.wallMin = glm::vec4(glm::vec3(scene.bounds.min - centre), 0);
    p.wallMax = glm::vec4(glm::vec3(scene.bounds.max - centre), 0);
    p.wireOrigin = glm::vec4(glm::vec3(glm::dvec3(wire.origin_x(), wire.origin_y(), wire.origin_z()) - centre),
                             wire.quantum() > 0 ? static_cast<float>(1 / wire.quantum()) : 0.0F);
    p.cells = glm::uvec4(plan.grid.cells, plan.grid.all());

    const double h = scene.step / scene.substeps;
    p.substep = static_cast<float>(h);
    p.perSubstep = static_cast<float>(1 / h);
    p.inverseCell = plan.grid.cellSize > 0 ? 1 / plan.grid.cellSize : 0.0F;
    p.margin = plan.grid.margin;
    p.rebuildMove = static_cast<float>(rebuildShare) * plan.grid.margin;
    p.radius = static_cast<float>(radii.largest);
    p.restitution = scene.spheres.empty() ? static_cast<float>(scene.restitution) : scene.spheres.front().restitution;
    p.wallRestitution = static_cast<float>(scene.bounds.restitution);
    setSleep(p, scene, plan);

    p.spheres = plan.spheres;
    p.groups = plan.groups() / 8;
    p.pairCapacity = plan.pairCapacity;
    for (unsigned face = 0; face < 6; ++face)
        if (!scene.bounds.open[face]) p.closedFaces |= 1U << face;
    for (const scene::Obstacle& obstacle : scene.obstacles)
        ++(std::holds_alternative<scene::Plane>(obstacle.shape) ? p.planes : p.boxes);
    p.statisticBlocks = (plan.spheres + STATISTIC_BLOCK - 1) / STATISTIC_BLOCK;
    return p;
}

std::vector<layout::Obstacle> obstaclesFor(const scene::Scene& scene) {
    std::vector<layout::Obstacle> planes;
    std::vector<layout::Obstacle> boxes;
    const glm::dvec3 centre = scene.bounds.centre();
    for (const scene::Obstacle& obstacle : scene.obstacles) {
        const auto e = static_cast<float>(obstacle.restitution);
        if (const auto* plane = std::get_if<scene::Plane>(&obstacle.shape)) {
            const double offset = glm::dot(plane->normal, plane->point - centre);
            planes.push_back({glm::vec4(glm::vec3(plane->normal), static_cast<float>(offset)), glm::vec4(0, 0, 0, e)});
        } else {
            const auto& box = std::get<scene::Box>(obstacle.shape);
            boxes.push_back({glm::vec4(glm::vec3(box.min - centre), 0), glm::vec4(glm::vec3(box.max - centre), e)});
        }
    }
    planes.insert(planes.end(), boxes.begin(), boxes.end());
    return planes;
}

}  // namespace spherule::sim
