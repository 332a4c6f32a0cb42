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
};

const Module modulePlanes{
    .feature = Feature::Planes,
    .required = hasAny<scene::Plane>,
    .declare = declareObstacles,
    .upload = [](const ParameterSource& from, layout::Parameters& p) { p.planes = count<scene::Plane>(from.scene); },
};

const Module moduleBoxes{
    .feature = Feature::Boxes,
    .required = hasAny<scene::Box>,
    .declare = declareObstacles,
    .upload = [](const ParameterSource& from, layout::Parameters& p) { p.boxes = count<scene::Box>(from.scene); },
};

}  // namespace spherule::sim
