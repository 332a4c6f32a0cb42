#include <algorithm>

#include "scene/materials.h"
#include "scene/shapes.h"
#include "sim/mesh_tables.h"
#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

template <scene::ShapeKind kind>
bool hasAny(const scene::Scene& scene, const Features& /*others*/) {
    return std::ranges::any_of(scene.obstacles, [](const scene::Obstacle& o) { return o.shape->kind() == kind; });
}

// An obstacle below the bed, which no sphere touches.
template <scene::ShapeKind kind>
void addBelow(scene::Scene& scene) {
    scene.obstacles.push_back({.shape = scene::exampleOf(kind, scene.bounds.min.z - 1), .colour = ""});
}

void addTurnedBox(scene::Scene& scene) {
    addBelow<scene::ShapeKind::Boxes>(scene);
    scene.obstacles.back().shape = scene::placedShape(scene.obstacles.back().shape, {}, {});
}

void addMovingBox(scene::Scene& scene) {
    addTurnedBox(scene);
    scene.obstacles.back().motion = scene::Motion{.spin = {0, 0, 1}};
}

void addDrivenBox(scene::Scene& scene) {
    addTurnedBox(scene);
    scene.obstacles.back().motion = scene::Motion{.drive = scene::Drive{.mostRate = 1}};
}

void declareObstacles(PlanBuilder& plan) {
    plan.arrays({Array::ContactParams, Array::Obstacles, Array::ObstacleLists});
    if (!plan.has(Feature::Contacts)) return;
    plan.arrays({Array::NearObstacles});
    plan.onRebuild(Stage::Lists, Pass::Lists, "list_obstacles.comp", LAUNCH_SPHERES);
}

}  // namespace

// A face of the bounds is closed.
const Module moduleWalls{
    .feature = Feature::Walls,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return scene::hasWalls(scene); },
    .declare = [](PlanBuilder& plan) { plan.arrays({Array::ContactParams}); },
    .cost = {.reason = "without walls, the bed has no floor"},
};

// There are obstacles. The lists of obstacles near spheres are made with the pair lists.
const Module moduleObstacles{
    .feature = Feature::Obstacles,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return !scene.obstacles.empty(); },
    .declare = declareObstacles,
    .upload =
        [](const ParameterSource& from, layout::Parameters& p) {
            p.obstacles = static_cast<std::uint32_t>(from.scene.obstacles.size());
            p.meshWords = from.plan.meshes ? static_cast<std::uint32_t>(from.plan.meshes->words.size()) : 0;
            p.obstacleListWords =
                static_cast<std::uint32_t>(from.plan.bytesOf(Array::ObstacleLists) / sizeof(std::uint32_t));
        },
    .cost = {.reason = "the rows of the shapes contain it"},
};

// An obstacle lies in a frame of its own: it is turned or moved, or its shape is given along an axis.
const Module moduleFrames{
    .feature = Feature::Frames,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return std::ranges::any_of(scene.obstacles, [](const scene::Obstacle& obstacle) {
                return obstacle.motion || obstacle.shape->row(glm::dvec3(0)).frame.has_value();
            });
        },
    .cost = {.name = "frames of obstacles", .without = addBelow<scene::ShapeKind::Boxes>, .with = addTurnedBox},
};

// An obstacle moves. The host uploads its place in each substep, from which the kernels know the motion of its surface.
const Module moduleMotion{
    .feature = Feature::Motion,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return scene::anyMoves(scene.obstacles); },
    .declare =
        [](PlanBuilder& plan) {
            if (plan.has(Feature::Sleep)) plan.overSpheres(Stage::Activity, Pass::Sleep, "wake_by_obstacles.comp");
        },
    .upload =
        [](const ParameterSource& from, layout::Parameters& p) {
            double fastest = 0;
            for (const scene::Obstacle& obstacle : from.scene.obstacles)
                fastest = std::max(fastest, obstacle.largestSpeed(from.scene.bounds));
            p.obstaclePath = static_cast<float>(fastest * from.substep);
        },
    .cost = {.name = "a moving obstacle", .without = addTurnedBox, .with = addMovingBox},
};

// An obstacle has a drive. The device sums its contacts, and the host integrates it (sim/drives.h).
const Module moduleDrives{
    .feature = Feature::Drives,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return std::ranges::any_of(scene.obstacles, [](const scene::Obstacle& obstacle) {
                return obstacle.motion && obstacle.motion->drive;
            });
        },
    .declare =
        [](PlanBuilder& plan) {
            plan.arrays({Array::SurfaceSums});
            if (plan.has(Feature::Balanced)) plan.overSpheres(Stage::Finish, Pass::Finish, "drive_contacts.comp");
        },
    .cost = {.name = "a driven body", .without = addMovingBox, .with = addDrivenBox},
};

// One module for each shape. Only its function in the kernels depends on it.
#define SHAPE(flag, Name, text, number, function)                          \
    const Module module##Name{                                             \
        .feature = Feature::Name,                                          \
        .required = hasAny<scene::ShapeKind::Name>,                        \
        .cost = {.name = #text, .with = addBelow<scene::ShapeKind::Name>}, \
    };
#include "shapes.def"
#undef SHAPE

}  // namespace spherule::sim
