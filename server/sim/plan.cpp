#include "sim/plan.h"

#include <algorithm>
#include <numeric>

#include "sim/layout.h"

namespace spherule::sim {

namespace {

constexpr std::uint32_t pairsPerSphere = 8;  // listed; a dense bed has about 5 within the margin
constexpr std::uint32_t fewestPairs = 1024;
constexpr std::uint32_t spheresPerBlock = 64;
constexpr std::uint64_t packedBlockBytes = 384;

std::uint32_t blocksOf(std::uint32_t values, std::uint32_t block) {
    return (values + block - 1) / block;
}

// Adds arrays and launches in the order in which a substep goes.
class Planner {
  public:
    explicit Planner(Plan& plan) : plan_(plan) {}

    void array(Array array, std::uint64_t elements, std::uint64_t elementBytes) {
        plan_.arrays.push_back({array, std::max<std::uint64_t>(elements, 1) * elementBytes});
    }

    void always(Pass pass, std::string_view kernel, std::vector<Array> slots, std::uint32_t count,
                std::uint32_t phase = 0) {
        plan_.substep.push_back({pass, kernel, std::move(slots), count, std::nullopt, phase});
    }

    void onRebuild(Pass pass, std::string_view kernel, std::vector<Array> slots, std::uint32_t row,
                   std::uint32_t phase = 0) {
        plan_.substep.push_back({pass, kernel, std::move(slots), plan_.fullLaunches.at(row), row, phase});
    }

  private:
    Plan& plan_;
};

void planArrays(Plan& plan, const scene::Scene& scene) {
    Planner add(plan);
    const scene::Features& has = plan.features;
    const std::uint64_t n = plan.spheres;
    add.array(Array::Position, n, 16);
    add.array(Array::Velocity, n, 16);
    if (has.needBefore()) add.array(Array::Before, n, 16);
    add.array(Array::Id, n, 4);
    if (has.restitutions) add.array(Array::Bounce, n, 4);
    if (has.planes || has.boxes) add.array(Array::Obstacles, scene.obstacles.size(), sizeof(layout::Obstacle));
    if (has.contacts) {
        const std::uint32_t cells = plan.grid.all();
        add.array(Array::CellStart, std::uint64_t{cells} + 1, 4);
        add.array(Array::BlockSums, blocksOf(cells + 1, SCAN_BLOCK), 4);
        add.array(Array::SuperSums, blocksOf(blocksOf(cells + 1, SCAN_BLOCK), SCAN_BLOCK), 4);
        add.array(Array::Place, n, 4);
        add.array(Array::Order, n, 4);
        add.array(Array::Saved, n * (plan.has(Array::Before) ? 3 : 2), 16);
        add.array(Array::SavedId, n, 4);
        add.array(Array::Anchor, n, 16);
        add.array(Array::SlotOf, n, 4);
        if (has.sleep) {
            add.array(Array::Resting, n, 16);
            add.array(Array::Woken, n, 4);
            add.array(Array::Stirred, plan.groups(), 4);
        }
        add.array(Array::Pairs, plan.pairCapacity, 8);
        add.array(Array::Touching, plan.pairCapacity, 8);
        add.array(Array::Span, plan.groups(), 16);
        add.array(Array::FullLaunches, LAUNCH_ROWS, 16);
        add.array(Array::Launches, LAUNCH_ROWS, 16);
        add.array(Array::Overlaps, plan.groups(), 16);
    }
    add.array(Array::Counters, COUNTER_WORDS, 4);
    add.array(Array::SphereParts, blocksOf(plan.spheres, STATISTIC_BLOCK), sizeof(layout::SphereStatistics));
    add.array(Array::Packed, blocksOf(plan.spheres, spheresPerBlock), packedBlockBytes);
}

void planGrid(Plan& plan) {
    using enum Array;
    Planner add(plan);
    const std::uint32_t values = plan.grid.all() + 1;
    const std::uint32_t blocks = blocksOf(values, SCAN_BLOCK);
    const std::uint32_t superBlocks = blocksOf(blocks, SCAN_BLOCK);
    plan.fullLaunches = {plan.spheres, values, blocks, superBlocks, 1, plan.groups()};

    add.always(Pass::Grid, "rebuild_plan.comp", {Counters, FullLaunches, Launches}, 1);
    if (plan.features.sleep)
        add.onRebuild(Pass::Grid, "wake.comp", {Position, Velocity, Before, CellStart, Span, Pairs, Woken},
                      LAUNCH_GROUPS);
    add.onRebuild(Pass::Grid, "state_save.comp", {Position, Velocity, Before, Id, Saved, SavedId, Woken},
                  LAUNCH_SPHERES);
    add.onRebuild(Pass::Grid, "cell_clear.comp", {CellStart}, LAUNCH_CELLS);
    add.onRebuild(Pass::Grid, "cell_count.comp", {Position, CellStart, Place}, LAUNCH_SPHERES);
    add.onRebuild(Pass::Grid, "scan_reduce.comp", {CellStart, BlockSums}, LAUNCH_BLOCKS, values);
    add.onRebuild(Pass::Grid, "scan_reduce.comp", {BlockSums, SuperSums}, LAUNCH_SUPERBLOCKS, blocks);
    add.onRebuild(Pass::Grid, "scan_top.comp", {SuperSums}, LAUNCH_ONE, superBlocks);
    add.onRebuild(Pass::Grid, "scan_spread.comp", {BlockSums, SuperSums}, LAUNCH_SUPERBLOCKS, blocks);
    add.onRebuild(Pass::Grid, "scan_spread.comp", {CellStart, BlockSums}, LAUNCH_BLOCKS, values);
    add.onRebuild(Pass::Grid, "cell_scatter.comp", {Position, CellStart, Place, Order}, LAUNCH_SPHERES);
    add.onRebuild(Pass::Grid, "cell_order.comp", {CellStart, Order, Id}, LAUNCH_CELLS);
    add.onRebuild(Pass::Grid, "state_gather.comp", {Position, Velocity, Before, Id, Saved, SavedId, Order},
                  LAUNCH_SPHERES);
    add.onRebuild(Pass::Grid, "state_anchor.comp", {Position, Id, Anchor, SlotOf}, LAUNCH_SPHERES);
    add.onRebuild(Pass::Lists, "list_build.comp", {Position, CellStart, Counters, Pairs, Span}, LAUNCH_GROUPS);
}

// The table of contents of a substep.
void planSubstep(Plan& plan) {
    using enum Array;
    Planner add(plan);
    const scene::Features& has = plan.features;
    const std::uint32_t n = plan.spheres;
    const std::uint32_t groupsPerColour = plan.groups() / 8;
    const bool obstructed = has.walls || has.planes || has.boxes;

    add.always(Pass::Integrate, "integrate.comp", {Position, Velocity, Before, Anchor, Id, Counters, Resting}, n);
    if (has.contacts) {
        planGrid(plan);
        if (has.sleep) {
            add.always(Pass::Sleep, "stir.comp", {Velocity, Anchor, Counters, Stirred}, n);
            add.always(Pass::Sleep, "stir_spread.comp", {Counters, Stirred, Span}, plan.groups());
        }
        for (std::uint32_t colour = 0; colour < 8; ++colour)
            add.always(Pass::Positions, "solve_positions.comp",
                       {Position, Velocity, Id, CellStart, Span, Pairs, Touching, Before}, groupsPerColour, colour);
    }
    if (obstructed)
        add.always(Pass::WallPositions, "walls_positions.comp", {Position, Velocity, Before, Obstacles, Id, Bounce}, n);
    if (has.contacts)
        for (std::uint32_t colour = 0; colour < 8; ++colour)
            add.always(Pass::Velocities, "solve_velocities.comp",
                       {Position, Velocity, Before, Id, CellStart, Span, Touching, Bounce}, groupsPerColour, colour);
    if (obstructed)
        add.always(Pass::WallVelocities, "walls_velocities.comp", {Position, Velocity, Before, Obstacles, Id, Bounce},
                   n);
    if (has.sleep) add.always(Pass::Sleep, "sleep.comp", {Velocity, Before}, n);
}

void planOnDemand(Plan& plan) {
    using enum Array;
    plan.statistics.push_back({Pass::Statistics,
                               "statistics_spheres.comp",
                               {Position, Velocity, Obstacles, SphereParts},
                               blocksOf(plan.spheres, STATISTIC_BLOCK),
                               std::nullopt,
                               0});
    if (plan.features.contacts)
        plan.statistics.push_back({Pass::Statistics,
                                   "statistics_contacts.comp",
                                   {Position, CellStart, Span, Pairs, Overlaps},
                                   plan.groups(),
                                   std::nullopt,
                                   0});
    plan.pack.push_back({Pass::Pack,
                         "pack.comp",
                         {Position, SlotOf, Packed},
                         blocksOf(plan.spheres, spheresPerBlock),
                         std::nullopt,
                         0});
}

}  // namespace

std::string_view wordsOf(Array array) {
    switch (array) {
        case Array::Position:
        case Array::Velocity:
        case Array::Before:
        case Array::Bounce:
        case Array::Obstacles:
        case Array::Saved:
        case Array::Anchor:
        case Array::Resting:
        case Array::Overlaps:
            return "r";
        case Array::SphereParts:
            return layout::statisticsWords;
        default:
            return "u";
    }
}

bool Plan::has(Array array) const {
    return bytesOf(array) > 0;
}

std::uint64_t Plan::bytesOf(Array array) const {
    for (const ArraySpec& spec : arrays)
        if (spec.array == array) return spec.bytes;
    return 0;
}

std::uint64_t Plan::bytes() const {
    return std::accumulate(arrays.begin(), arrays.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const ArraySpec& spec) { return sum + spec.bytes; });
}

Radii radiiOf(const scene::Scene& scene) {
    if (scene.spheres.empty()) return {0.05, 0.05, 0.05};
    Radii radii{1e30, 0, 0};
    for (const scene::Sphere& sphere : scene.spheres) {
        const auto r = static_cast<double>(sphere.radius);
        radii.smallest = std::min(radii.smallest, r);
        radii.largest = std::max(radii.largest, r);
        radii.mean += r / static_cast<double>(scene.spheres.size());
    }
    return radii;
}

Plan planFor(const scene::Scene& scene, const scene::Features& features, std::uint32_t spheres, const Radii& radii,
             std::uint32_t pairCapacity) {
    Plan plan;
    plan.features = features;
    plan.spheres = spheres;
    plan.substeps = scene.substeps;
    if (features.contacts) {
        plan.grid = gridFor(scene.bounds.max - scene.bounds.min, radii.largest, radii.mean, spheres);
        plan.pairCapacity = pairCapacity != 0 ? pairCapacity : std::max(fewestPairs, pairsPerSphere * spheres);
    }
    planArrays(plan, scene);
    planSubstep(plan);
    planOnDemand(plan);
    return plan;
}

}  // namespace spherule::sim
