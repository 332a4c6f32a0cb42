#include "sim/parameters.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "scene/materials.h"
#include "scene/stiffness.h"

namespace spherule::sim {

namespace {

// Lists hold until a sphere has moved this share of the margin: two may approach each other, and the position pass
// moves them a little further before the next check.
constexpr double rebuildShare = 0.45;

void setGrid(layout::Parameters& p, const Grid& grid) {
    auto inverse = [](const Level& level) { return level.cellSize > 0 ? 1 / level.cellSize : 0.0F; };
    p.cells = glm::uvec4(grid.coarsest().cells, grid.all());
    p.inverseCell = inverse(grid.coarsest());
    p.levels = static_cast<std::uint32_t>(grid.levels.size());
    for (std::size_t k = 0; k < grid.levels.size(); ++k) {
        const Level& level = grid.levels[k];
        p.levelSize[k] = glm::vec4(inverse(level), level.largest, level.crowd, 0);
        p.levelCells[k] = glm::uvec4(level.cells, level.first);
    }
    p.margin = grid.margin;
    p.rebuildMove = static_cast<float>(rebuildShare) * grid.margin;
}

void setSleep(layout::Parameters& p, const scene::Scene& scene, const Plan& plan, double h) {
    const double g = glm::length(scene.gravity);
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

double springModulusOf(const scene::Scene& scene) {
    return scene.quality.model == scene::Model::Accurate ? scene::springModulus(scene) : 0;
}

layout::Law lawFor(const scene::Scene& scene, std::uint8_t a, std::uint8_t b, double springModulus) {
    const scene::PairLaw contact = scene::lawBetween(scene, a, b);
    layout::Law law{.contact = glm::vec4(contact.restitution, contact.friction, contact.rollingResistance,
                                         contact.spinningResistance),
                    .stiffness = {}};
    if (scene.quality.model == scene::Model::Accurate) {
        const scene::Stiffness stiffness = scene::stiffnessBetween(scene, a, b, springModulus);
        law.stiffness = glm::vec4(stiffness.normal, stiffness.damping, stiffness.tangential, 0);
    }
    return law;
}

}  // namespace

layout::Parameters parametersFor(const scene::Scene& scene, const Plan& plan, const Radii& radii, double substep) {
    layout::Parameters p{};
    const glm::dvec3 centre = scene.bounds.centre();
    p.gravity = glm::vec4(glm::vec3(scene.gravity), 0);
    p.wallMin = glm::vec4(glm::vec3(scene.bounds.min - centre), 0);
    p.wallMax = glm::vec4(glm::vec3(scene.bounds.max - centre), 0);
    setGrid(p, plan.grid);

    const double h = substep;
    p.substep = static_cast<float>(h);
    p.perSubstep = static_cast<float>(1 / h);
    p.step = static_cast<float>(scene.step);
    p.radius = static_cast<float>(radii.largest);
    p.deadBand = static_cast<float>(2 * glm::length(scene.gravity) * h);
    p.materials = static_cast<std::uint32_t>(scene.materials.size());
    p.material = scene.spheres.empty() ? 0U : scene.spheres.front().material;
    p.wallMaterial = scene.bounds.material;
    p.wallContacts = plan.wallContacts;
    const layout::Law law = lawFor(scene, static_cast<std::uint8_t>(p.material), static_cast<std::uint8_t>(p.material),
                                   springModulusOf(scene));
    p.law = law.contact;
    p.stiffness = law.stiffness;
    setSleep(p, scene, plan, h);

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

std::vector<layout::Law> lawsFor(const scene::Scene& scene) {
    std::vector<layout::Law> laws;
    const std::size_t count = scene.materials.size();
    const double modulus = springModulusOf(scene);
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b)
            laws.push_back(lawFor(scene, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), modulus));
    return laws;
}

std::vector<layout::Obstacle> obstaclesFor(const scene::Scene& scene) {
    std::vector<layout::Obstacle> planes;
    std::vector<layout::Obstacle> boxes;
    const glm::dvec3 centre = scene.bounds.centre();
    for (const scene::Obstacle& obstacle : scene.obstacles) {
        const auto material = static_cast<float>(obstacle.material);
        if (const auto* plane = std::get_if<scene::Plane>(&obstacle.shape)) {
            const double offset = glm::dot(plane->normal, plane->point - centre);
            planes.push_back(
                {glm::vec4(glm::vec3(plane->normal), static_cast<float>(offset)), glm::vec4(0, 0, 0, material)});
        } else {
            const auto& box = std::get<scene::Box>(obstacle.shape);
            boxes.push_back(
                {glm::vec4(glm::vec3(box.min - centre), 0), glm::vec4(glm::vec3(box.max - centre), material)});
        }
    }
    planes.insert(planes.end(), boxes.begin(), boxes.end());
    return planes;
}

void writeConstants(Pipeline& pipeline, const scene::Scene& scene) {
    if (pipeline.plan().has(Array::Obstacles)) pipeline.write<layout::Obstacle>(Array::Obstacles, obstaclesFor(scene));
    if (pipeline.plan().has(Array::Laws)) pipeline.write<layout::Law>(Array::Laws, lawsFor(scene));
}

}  // namespace spherule::sim
