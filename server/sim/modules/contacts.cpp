#include <algorithm>
#include <limits>

#include "scene/random.h"
#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

// The lists are rebuilt when a sphere has moved this share of the margin. It is below one half: two spheres may
// approach each other, and a solver moves them a little further before the next check.
constexpr double rebuildShare = 0.45;

bool radiiDiffer(const scene::Scene& scene) {
    float smallest = std::numeric_limits<float>::infinity();
    float largest = 0;
    scene::forEachSphere(scene, [&](const scene::Sphere& sphere, double /*weight*/) {
        smallest = std::min(smallest, sphere.radius);
        largest = std::max(largest, sphere.radius);
    });
    return smallest < largest;
}

void declareLists(PlanBuilder& plan) {
    using enum Array;
    plan.arrays({CellStart,   BlockSums,     SuperSums, RankInCell,    CellOrder,    SortScratch, SortScratchWords,
                 SlotOf,      ListReference, SortedX,   SortedY,       SortedZ,      GroupRange,  Candidates,
                 BusyBatches, Pairs,         Bundles,   DispatchSizes, DispatchArgs, Overlaps});
    if (plan.has(Feature::Radii)) plan.arrays({SortedRadius});
    // The scratch column is free until the columns are sorted.
    const std::vector<Alias> cellOfSphere{{"cellOfSphere", SortScratchWords}};
    plan.decidesRebuild(Stage::Rebuild, Pass::Grid, "rebuild_decide.comp");
    plan.onRebuild(Stage::SortCells, Pass::Grid, "cell_clear.comp", LAUNCH_CELLS);
    plan.onRebuild(Stage::SortCells, Pass::Grid, "cell_count.comp", LAUNCH_SPHERES, cellOfSphere);
    plan.prefixSumOnRebuild(Stage::SortCells, Pass::Grid, CellStart, {LAUNCH_BLOCKS, LAUNCH_SUPERBLOCKS},
                            plan.plan().grid.all() + 1);
    if (plan.has(Feature::Movers)) plan.onRebuild(Stage::SortCells, Pass::Grid, "mover_cells.comp", LAUNCH_MOVER_CELLS);
    plan.onRebuild(Stage::SortCells, Pass::Grid, "cell_scatter.comp", LAUNCH_SPHERES, cellOfSphere);
    plan.onRebuild(Stage::SortCells, Pass::Grid, "cell_order.comp", LAUNCH_CELL_RUNS, {{"otherOrder", RankInCell}});
    plan.onRebuild(Stage::Reference, Pass::Grid, "list_reference.comp", LAUNCH_SPHERES);
    plan.onRebuild(Stage::Reference, Pass::Grid, "list_drift.comp", LAUNCH_ONE);
    plan.onRebuild(Stage::Lists, Pass::Lists, "list_build.comp", LAUNCH_GROUPS);
    plan.overLevelsOnRebuild(Stage::Lists, Pass::Lists, "list_order.comp");
    plan.onRebuild(Stage::Lists, Pass::Lists, "list_fit.comp", LAUNCH_FIT);
    plan.statisticsOfBundles("statistics_contacts.comp", {{"touching", touchingArray}});
}

void uploadGrid(const ParameterSource& from, layout::Parameters& p) {
    const Grid& grid = from.plan.grid;
    const auto inverse = [](const Level& level) { return level.cellSize > 0 ? 1 / level.cellSize : 0.0F; };
    p.cells = glm::uvec4(grid.coarsest().cells, grid.all());
    p.inverseCell = inverse(grid.coarsest());
    p.levels = static_cast<std::uint32_t>(grid.levels.size());
    for (std::size_t k = 0; k < grid.levels.size(); ++k) {
        const Level& level = grid.levels[k];
        p.levelSize[k] = glm::vec4(inverse(level), level.largest, level.sampleThreshold, 0);
        p.cellsPerMetre[k] = glm::vec4(glm::vec3(1.0 / level.widths), 0);
        p.levelCells[k] = glm::uvec4(level.cells, level.first);
        p.levelBundles[k] = glm::uvec4(level.firstBundle, level.bundlesOfColour(), 0, 0);
    }
    p.margin = grid.margin;
    p.rebuildMove = static_cast<float>(rebuildShare) * grid.margin;
    p.bundles = grid.bundles();
    p.mostMovers = from.plan.mostMovers;
    p.farSlot = from.plan.room;
    if (grid.hasMovers) {
        p.moverLevel = static_cast<std::uint32_t>(grid.levels.size() - 1);
        p.firstMoverCell = grid.levels.back().first;
    }
    p.pairCapacity = from.plan.pairCapacity;
}

}  // namespace

// Contacts between spheres: a cell grid, and lists of near pairs that are built from it.
const Module moduleContacts{
    .feature = Feature::Contacts,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return scene.sphereContacts; },
    .declare = declareLists,
    .upload = uploadGrid,
    .cost = {.reason = "without contacts, there is no bed"},
};

// Radii differ.
const Module moduleRadii{
    .feature = Feature::Radii,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return radiiDiffer(scene); },
    .cost = {.name = "radii that differ",
             // Varies radii by at most 1e-5, so that both scenes have the same contacts.
             .with =
                 [](scene::Scene& scene) {
                     scene::Random random(4);
                     for (scene::Sphere& sphere : scene.spheres)
                         sphere.radius *= static_cast<float>(random.uniform(0.99999, 1.00001));
                 }},
};

// Radii differ so much that each size class has its own grid. planFor() sets the feature, because it makes the grid.
const Module moduleLevels{
    .feature = Feature::Levels,
    .required = [](const scene::Scene& /*scene*/, const Features& /*others*/) { return false; },
    .cost = {.reason = "the case `sizes` measures it"},
};

// Spheres that move among sleeping ones have lists of their own (shaders/shared/movers.h). planFor() sets the feature,
// because it makes the grid.
const Module moduleMovers{
    .feature = Feature::Movers,
    .required = [](const scene::Scene& /*scene*/, const Features& /*others*/) { return false; },
    .declare =
        [](PlanBuilder& plan) {
            plan.arrays({Array::IsMover, Array::MoverSlots, Array::LeftBlock});
            plan.onRebuild(Stage::Movers, Pass::Grid, "movers_collect.comp", LAUNCH_COLLECT);
        },
    .cost = {.reason = "part of sleep in scenes of many spheres"},
};

// A face of the bounds is open: spheres may leave.
const Module moduleOpenFaces{
    .feature = Feature::OpenFaces,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return std::ranges::find(scene.bounds.open, true) != scene.bounds.open.end();
        },
    .declare =
        [](PlanBuilder& plan) {
            if (plan.has(Feature::Contacts))
                plan.onRebuild(Stage::Outside, Pass::Lists, "list_outside.comp", LAUNCH_OUTSIDE);
        },
    .cost = {.name = "open top",
             .without = [](scene::Scene& scene) { scene.bounds.open[scene::ZMax] = false; },
             .with = [](scene::Scene& scene) { scene.bounds.open[scene::ZMax] = true; }},
};

}  // namespace spherule::sim
