#include "sim/plan.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "scene/load.h"
#include "scene/shapes.h"
#include "sim/drives.h"
#include "sim/layout.h"
#include "sim/mesh_tables.h"
#include "sim/modules/module.h"
#include "sim/pipeline.h"

namespace spherule::sim {

namespace {

constexpr std::uint32_t pairsPerSphere = 8;  // listed; a dense bed has about 6 within the margin
constexpr std::uint32_t pairsPerMover = 6;   // in addition, for the two rooms of their pairs (shaders/shared/movers.h)
constexpr std::uint32_t fewestPairs = 1024;
constexpr std::uint32_t wallHistoryLimit = 8;

// The gap up to which pairs are listed, in radii. A wider gap lists more pairs, a narrower gap causes more rebuilds.
// `balanced` tests a pair at little cost. Where radii differ, a rebuild costs more.
double marginInRadii(const Features& features) {
    if (!features.has(Feature::Balanced)) return 0.3;
    return features.has(Feature::Radii) ? 1.0 : 0.8;
}

// Returns for how many spheres a new simulation of `spheres` has room, so that the first ones to be added need no
// larger arrays.
constexpr std::uint32_t roomFor(std::uint32_t spheres) {
    constexpr std::uint32_t fewestSpare = 64;
    return spheres + std::max(fewestSpare, spheres / 64);
}
static_assert(roomFor(scene::maxSpheres) <= Pipeline::mostHandles);

// Returns the size of the lists of obstacles (words): the two at their beginning, and lists of `mostNear` obstacles for
// each sphere on average. A sphere for whose list there is no space visits all obstacles.
std::uint64_t obstacleListWords(std::uint64_t obstacles, std::uint64_t spheres) {
    constexpr std::uint64_t mostNear = 3;
    return obstacles + 2 + spheres * (std::min(obstacles, mostNear) + 1);
}

std::uint64_t elementsOf(Extent extent, const Plan& plan, const scene::Scene& scene) {
    const std::uint64_t n = plan.room;
    const std::uint32_t cells = plan.grid.all();
    const std::uint32_t scanned = cells + 1;
    switch (extent) {
        case Extent::Sphere:
            return n + (plan.grid.hasMovers ? 1 : 0);
        case Extent::SphereAndColour:
            return 8 * n;
        case Extent::Entry:
            return n + plan.mostMovers;
        case Extent::PaddedEntry:
            return n + plan.mostMovers + PAIR_PADDING;
        case Extent::Mover:
            return plan.mostMovers;
        case Extent::RememberedWall:
            return n * plan.maxWallHistory;
        case Extent::CellEnd:
            return std::uint64_t{cells} + 1;
        case Extent::Group:
            return plan.groups();
        case Extent::Block:
            return cells / 64;
        case Extent::Bundle:
            return plan.grid.bundles();
        case Extent::BundleWord:
            return (std::uint64_t{plan.grid.bundles()} + 1) * BUNDLE_WORDS +
                   (plan.features.has(Feature::ContactSums)
                        ? std::uint64_t{plan.grid.bundles()} * MOST_PAIR_THREADS * SUM_WORDS
                        : 0);
        case Extent::Pair:
            return plan.pairCapacity;
        case Extent::PairTwice:
            return 2 * std::uint64_t{plan.pairCapacity};
        case Extent::CarriedContact:
            return n * CARRIED_MOST;
        case Extent::ScanBlock:
            return blocksOf(scanned, SCAN_BLOCK);
        case Extent::ScanSuperBlock:
            return blocksOf(blocksOf(scanned, SCAN_BLOCK), SCAN_BLOCK);
        case Extent::LaunchRow:
            return 2 * LAUNCH_ROWS;
        case Extent::Obstacle:
            return scene.obstacles.size() +
                   static_cast<std::uint64_t>(
                       std::ranges::count_if(scene.obstacles, [](const auto& one) { return one.motion.has_value(); }));
        case Extent::ObstacleListWord:
            return obstacleListWords(scene.obstacles.size(), plan.features.has(Feature::Contacts) ? n : 0) +
                   (plan.meshes ? plan.meshes->words.size() : 0);
        case Extent::MaterialPair:
            return scene.materials.size() * scene.materials.size();
        case Extent::Counter:
            return COUNTER_WORDS;
        case Extent::StatisticBlock:
            return blocksOf(plan.room, STATISTIC_BLOCK);
        case Extent::PullRow:
            return std::uint64_t{MOST_PULLS} * PULL_ROWS;
        case Extent::BirthRow:
            return std::uint64_t{MOST_BIRTH_PLACES} / BIRTH_CHUNK * BIRTH_CHUNK_ROWS;
        case Extent::BirthPlace:
            return MOST_BIRTH_PLACES;
        case Extent::SurfaceSumWord:
            return std::uint64_t{scene::surfacesOf(scene)} * surfaceSumWords + driveSumWords(scene);
        case Extent::InspectedWord:
            return 1 + 2 * std::uint64_t{INSPECTED_MOST};
    }
    return 0;
}

std::uint32_t invocationsOver(Varying what, const Plan& plan) {
    switch (what) {
        case Varying::Spheres:
            return plan.spheres;
        case Varying::StatisticBlocks:
            return blocksOf(plan.spheres, STATISTIC_BLOCK);
        case Varying::PairsTwice:
            return 2 * plan.pairCapacity;
        case Varying::Nothing:
            break;
    }
    return 0;
}

// Returns for how many spheres lists of movers have room. If more spheres are awake, lists of all spheres cost little
// more.
std::uint32_t mostMoversOf(std::uint32_t spheres) {
    constexpr std::uint32_t least = 1024;
    constexpr std::uint32_t most = 1U << 17U;
    return std::min(spheres / 8 + least, most);
}

// Returns for how many spheres a new plan has lists of movers. They are worth while if spheres sleep, and if lists of
// all spheres take long.
std::uint32_t newMovers(const Features& features, std::uint32_t spheres, const Grid& grid) {
    constexpr std::uint32_t few = 2000;
    const bool sleeps = features.has(Feature::Sleep) && !features.has(Feature::Periodic);
    return sleeps && grid.sizes() == 1 && spheres >= few ? mostMoversOf(spheres) : 0;
}

// Returns `count` of the launches per row of the launch table: for lists of all spheres, then for lists of movers.
std::vector<std::uint32_t> launchTable(const Plan& plan) {
    const std::uint32_t cells = plan.grid.all() + 1;
    const std::uint32_t cellBlocks = blocksOf(cells, SCAN_BLOCK);
    std::uint32_t colour = 0;  // bundles of a colour
    for (const Level& level : plan.grid.levels) colour = std::max(colour, level.bundlesOfColour());
    std::vector<std::uint32_t> rows(LAUNCH_ROWS);
    rows[LAUNCH_SPHERES] = plan.spheres;
    rows[LAUNCH_CELLS] = cells;
    rows[LAUNCH_BLOCKS] = cellBlocks;
    rows[LAUNCH_SUPERBLOCKS] = blocksOf(cellBlocks, SCAN_BLOCK);
    rows[LAUNCH_ONE] = 1;
    rows[LAUNCH_GROUPS] = plan.groups();
    rows[LAUNCH_OUTSIDE] = MOST_OUTSIDE;
    rows[LAUNCH_FIT] = plan.grid.bundles();
    rows[LAUNCH_BUNDLES] = plan.grid.bundles();
    rows[LAUNCH_COLOUR] = colour;
    rows[LAUNCH_LEVEL] = 8 * colour;
    rows[LAUNCH_CELL_RUNS] = blocksOf(plan.grid.all(), ORDERED_CELLS);
    rows[LAUNCH_COLUMNS] = plan.spheres;
    rows[LAUNCH_LOST_SPHERES] = plan.spheres;
    rows[LAUNCH_LOST_COLOUR] = colour;
    rows[LAUNCH_UNLISTED] = colour;
    if (!plan.grid.hasMovers) {
        rows.resize(std::size_t{2} * LAUNCH_ROWS);
        return rows;
    }
    const Level& level = plan.grid.levels.back();
    rows[LAUNCH_MOVER_LEVEL] = 8 * level.bundlesOfColour();
    rows[LAUNCH_MOVERS] = level.bundlesOfColour();
    std::vector<std::uint32_t> alone = rows;
    for (const std::uint32_t row : {LAUNCH_BLOCKS, LAUNCH_SUPERBLOCKS, LAUNCH_OUTSIDE, LAUNCH_LEVEL, LAUNCH_COLUMNS})
        alone[row] = 0;
    alone[LAUNCH_SPHERES] = plan.mostMovers;  // rebuild_decide.comp sets fewer
    alone[LAUNCH_CELLS] = level.all() + 1;
    alone[LAUNCH_GROUPS] = level.all() / 8;
    alone[LAUNCH_FIT] = rows[LAUNCH_MOVER_LEVEL];
    alone[LAUNCH_CELL_RUNS] = blocksOf(level.all(), ORDERED_CELLS);
    alone[LAUNCH_COLLECT] = plan.spheres;
    alone[LAUNCH_MOVER_CELLS] = 1;
    alone[LAUNCH_FORGET] = plan.grid.bundles();
    rows.insert(rows.end(), alone.begin(), alone.end());
    return rows;
}

void updateLaunches(Plan& plan) {
    for (auto* launches : {&plan.substep, &plan.newSubstep, &plan.statistics, &plan.stepEnd, &plan.figures,
                           &plan.inspection, &plan.births})
        for (LaunchSpec& launch : *launches) {
            if (launch.launchRow)
                launch.count = std::max(plan.dispatchSizes.at(*launch.launchRow),
                                        plan.dispatchSizes.at(LAUNCH_ROWS + *launch.launchRow));
            if (launch.over != Varying::Nothing) launch.count = invocationsOver(launch.over, plan);
        }
}

// Adds the launches that only viewers and emitters ask for.
void addRequests(Plan& plan) {
    const std::vector<Alias> aliases{{"touching", touchingArray}, {"deepest", deepestArray}};
    const auto over = [](Varying what, std::string_view kernel, std::vector<Alias> bound) {
        return LaunchSpec{.pass = Pass::Statistics, .kernel = kernel, .over = what, .aliases = std::move(bound)};
    };
    plan.figures.push_back(over(Varying::Spheres, "figures_surfaces.comp", aliases));
    if (plan.features.has(Feature::Contacts)) {
        plan.figures.push_back(over(Varying::Nothing, "figures_contacts.comp", aliases));
        plan.figures.back().count = plan.grid.bundles();
    }
    plan.figures.push_back(over(Varying::Spheres, "figures.comp", aliases));
    plan.figures.back().aliases.push_back({"figures", figuresArray});
    plan.inspection.push_back(over(Varying::Spheres, "inspect.comp", {}));
    plan.births.push_back(over(Varying::Spheres, "birth_places.comp", {}));
    updateLaunches(plan);
}

}  // namespace

bool Plan::has(Array array) const {
    return bytesOf(array) > 0;
}

std::uint64_t Plan::bytesOf(Array array) const {
    for (const ArraySpec& spec : arrays)
        if (spec.array == array) return spec.bytes;
    return 0;
}

std::uint64_t Plan::bytesFor(Array array, const scene::Scene& scene) const {
    const ArrayType& type = typeOf(array);
    return std::max<std::uint64_t>(elementsOf(type.extent, *this, scene), 1) * type.elementBytes;
}

void Plan::setSpheres(std::uint32_t count) {
    spheres = count;
    if (features.has(Feature::Contacts)) dispatchSizes = launchTable(*this);
    updateLaunches(*this);
}

void Plan::setPairCapacity(std::uint32_t pairs) {
    pairCapacity = pairs;
    updateLaunches(*this);
}

std::uint64_t Plan::bytes() const {
    return std::accumulate(arrays.begin(), arrays.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const ArraySpec& spec) { return sum + spec.bytes; });
}

SubstepCost costOf(const Plan& plan, bool rebuild) {
    SubstepCost cost;
    for (const LaunchSpec& launch : plan.substep)
        cost.launches += !launch.observing && (rebuild || !launch.launchRow) ? 1 : 0;
    // Each launch has one. The host reads a word after each substep, which takes one before the copy and one after it.
    // The arguments of indirect launches are written three times.
    cost.barriers = cost.launches;
    if (plan.features.has(Feature::Contacts)) cost.barriers += rebuild ? 5 : 2;
    return cost;
}

std::uint32_t mostBatches(const Plan& plan) {
    if (!plan.features.has(Feature::Contacts)) return 0;
    return 8 * BATCHES * static_cast<std::uint32_t>(plan.grid.levels.size());
}

namespace {

Plan planWith(const scene::Scene& scene, const Features& features, std::uint32_t spheres, std::uint32_t room,
              const RadiusStats& radii, std::uint32_t pairCapacity, std::optional<std::uint32_t> mostMovers) {
    Plan plan;
    plan.features = features;
    plan.model = scene.quality.model;
    plan.spheres = spheres;
    plan.room = room;
    plan.periods = scene.bounds.periods();
    if (features.has(Feature::Contacts)) {
        plan.grid = gridFor(scene.bounds, radii, marginInRadii(features));
        plan.mostMovers = mostMovers.value_or(newMovers(features, spheres, plan.grid));
        if (plan.mostMovers > 0) addMoverLevel(plan.grid, scene.bounds, radii, plan.mostMovers);
        plan.features.set(Feature::Movers, plan.grid.hasMovers);
        plan.features.set(Feature::Levels, plan.grid.levels.size() > 1);
        plan.pairCapacity = pairCapacity != 0
                                ? pairCapacity
                                : std::max(fewestPairs, pairsPerSphere * spheres) +
                                      8 * PAIR_PADDING * static_cast<std::uint32_t>(plan.grid.levels.size()) +
                                      pairsPerMover * plan.mostMovers;
        plan.dispatchSizes = launchTable(plan);
    }
    if (features.has(Feature::Meshes)) plan.meshes = meshTablesFor(scene, radii.largest);
    if (features.hasSurfaceFeature()) {
        // `balanced` has one for each axis of the bounds, before the ones for obstacles.
        const std::uint32_t unused = features.has(Feature::Balanced) ? 3 : 0;
        // A sphere may touch any number of parts of a mesh.
        plan.maxWallHistory = features.has(Feature::Meshes)
                                  ? wallHistoryLimit
                                  : std::min(wallHistoryLimit, scene::surfacesOf(scene) - unused);
    }
    PlanBuilder builder(plan, scene);
    builder.arrays(
        {Array::Position, Array::Velocity, Array::IdAndMaterial, Array::Counters, Array::SphereSums, Array::Inspected});
    if (features.has(Feature::Contacts) || features.hasSurfaceFeature()) builder.arrays({touchingArray});
    if (!features.has(Feature::Balanced)) builder.overSpheres(Stage::Integrate, Pass::Integrate, "integrate.comp");
    builder.statisticsOfSpheres("statistics_spheres.comp", {{"touching", touchingArray}});
    for (const Module* module : modules())
        if (module->declare != nullptr && plan.features.has(module->feature)) module->declare(builder);
    builder.finish();
    addRequests(plan);
    return plan;
}

}  // namespace

Plan planFor(const scene::Scene& scene, const Features& features, std::uint32_t spheres, const RadiusStats& radii,
             std::uint32_t pairCapacity) {
    return planWith(scene, features, spheres, roomFor(spheres), radii, pairCapacity, std::nullopt);
}

PlanNumbers numbersOf(const Plan& plan) {
    return {.features = plan.features,
            .spheres = plan.spheres,
            .room = plan.room,
            .pairCapacity = plan.pairCapacity,
            .mostMovers = plan.mostMovers};
}

Plan planOf(const scene::Scene& scene, const RadiusStats& radii, const PlanNumbers& numbers) {
    return planWith(scene, numbers.features, numbers.spheres, numbers.room, radii, numbers.pairCapacity,
                    numbers.mostMovers);
}

Plan planAsOf(const Plan& other, const scene::Scene& scene, const Features& features, const RadiusStats& radii) {
    // Without sleep, none moves among sleepers.
    const std::uint32_t mostMovers = features.has(Feature::Sleep) ? other.mostMovers : 0;
    return planWith(scene, features, other.spheres, other.room, radii, other.pairCapacity, mostMovers);
}

}  // namespace spherule::sim
