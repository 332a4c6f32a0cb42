#include <algorithm>
#include <variant>

#include "scene/materials.h"
#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

template <class Shape>
bool hasAny(const scene::Scene& scene, const Features& /*others*/) {
    return std::ranges::any_of(scene.obstacles,
                               [](const scene::Obstacle& o) { return std::holds_alternative<Shape>(o.shape); });
}

template <class Shape>
std::uint32_t count(const scene::Scene& scene) {
    return static_cast<std::uint32_t>(std::ranges::count_if(
        scene.obstacles, [](const scene::Obstacle& o) { return std::holds_alternative<Shape>(o.shape); }));
}

void declareObstacles(PlanBuilder& plan) {
    plan.arrays({Array::ContactParams, Array::Obstacles});
}

}  // namespace

// A face of the bounds is closed.
const Module moduleWalls{
    .feature = Feature::Walls,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return scene::hasWalls(scene); },
    .declare = [](PlanBuilder& plan) { plan.arrays({Array::ContactParams}); },
    .cost = {.reason = "without walls, the bed has no floor"},
};

const Module modulePlanes{
    .feature = Feature::Planes,
    .required = hasAny<scene::Plane>,
    .declare = declareObstacles,
    .upload = [](const ParameterSource& from, layout::Parameters& p) { p.planes = count<scene::Plane>(from.scene); },
    .cost =
        {.name = "a plane",
         .with =
             [](scene::Scene& scene) {
                 const glm::dvec3 below = scene.bounds.min - glm::dvec3(1);
                 scene.obstacles.push_back({.shape = scene::Plane{.point = below, .normal = {0, 0, 1}}, .colour = ""});
             }},
};

const Module moduleBoxes{
    .feature = Feature::Boxes,
    .required = hasAny<scene::Box>,
    .declare = declareObstacles,
    .upload = [](const ParameterSource& from, layout::Parameters& p) { p.boxes = count<scene::Box>(from.scene); },
    .cost = {.name = "a box",
             .with =
                 [](scene::Scene& scene) {
                     const glm::dvec3 corner = scene.bounds.min;
                     const scene::Box box{.min = corner - glm::dvec3(2), .max = corner - glm::dvec3(1)};
                     scene.obstacles.push_back({.shape = box, .colour = ""});
                 }},
};

}  // namespace spherule::sim
