#include "sim/plan.h"

#include <algorithm>
#include <numeric>

#include "sim/layout.h"

namespace spherule::sim {

namespace {

constexpr std::uint32_t pairsPerSphere = 8;  // listed; a dense bed has about 5 within the margin
constexpr std::uint32_t fewestPairs = 1024;
constexpr std::uint32_t mostWallContacts = 8;

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

    void whenObserved(std::string_view kernel, std::vector<Array> slots, std::uint32_t count) {
        plan_.substep.push_back({Pass::Statistics, kernel, std::move(slots), count, std::nullopt, 0, true});
    }

  private:
    Plan& plan_;
};

void planArrays(Plan& plan, const scene::Scene& scene) {
    Planner add(plan);
    const scene::Features& has = plan.features;
    const std::uint64_t n = plan.spheres;
    const bool accurate = has.model == scene::Model::Accurate;
    const std::uint64_t materials = scene.materials.size();
    const std::uint64_t sections = 2 + (has.needBefore() ? 1 : 0) + (has.friction ? 1 : 0) + (accurate ? 1 : 0);
    add.array(Array::Position, accurate ? 2 * n : n, 16);
    add.array(Array::Velocity, (has.friction ? 2 : 1) * (has.forces() ? 2 : 1) * n, 16);
    if (has.needBefore()) add.array(Array::Before, n, 16);
    add.array(Array::Label, n, 4);
    if (has.materials || has.obstructed()) add.array(Array::Laws, materials * materials, sizeof(layout::Law));
    if (has.obstructed() && has.friction) {
        if (has.model == scene::Model::Balanced) add.array(Array::Pressed, n, 16);
        if (accurate) add.array(Array::WallHistory, n * plan.wallContacts, 16);
    }
    if (has.model == scene::Model::Fast && has.obstructed() && has.gravity) add.array(Array::Work, n, 4);
    if (has.planes || has.boxes) add.array(Array::Obstacles, scene.obstacles.size(), sizeof(layout::Obstacle));
    if (has.contacts) {
        const std::uint32_t cells = plan.grid.all();
        add.array(Array::CellStart, std::uint64_t{cells} + 1, 4);
        const bool remembers = accurate && has.friction;
        const std::uint32_t values = std::max(cells, remembers ? plan.spheres : 0) + 1;
        add.array(Array::BlockSums, blocksOf(values, SCAN_BLOCK), 4);
        add.array(Array::SuperSums, blocksOf(blocksOf(values, SCAN_BLOCK), SCAN_BLOCK), 4);
        add.array(Array::Place, n, 4);
        add.array(Array::Order, n, 4);
        add.array(Array::Saved, n * sections, 16);
        add.array(Array::SavedLabel, n, 4);
        add.array(Array::Anchor, n, 16);
        add.array(Array::SlotOf, n, 4);
        if (has.sleep) {
            add.array(Array::Resting, n, 16);
            add.array(Array::Woken, n, 4);
            add.array(Array::Stirred, plan.groups(), 4);
        }
        add.array(Array::Pairs, std::uint64_t{plan.pairCapacity} * plan.pairSections(), 8);
        if (remembers) {
            add.array(Array::History, plan.pairCapacity, 16);
            add.array(Array::Kept, plan.pairCapacity, 16);
            add.array(Array::KeptStart, n + 1, 4);
        }
        add.array(Array::Span, plan.groups(), 16);
        add.array(Array::FullLaunches, LAUNCH_ROWS, 16);
        add.array(Array::Launches, LAUNCH_ROWS, 16);
        add.array(Array::Overlaps, plan.groups(), 16);
        if (!accurate) add.array(Array::Impacts, plan.groups(), 16);
    }
    add.array(Array::Counters, COUNTER_WORDS, 4);
    add.array(Array::SphereParts, blocksOf(plan.spheres, STATISTIC_BLOCK), sizeof(layout::SphereStatistics));
}

// Turns the values of an array into exclusive prefix sums, in blocks of blocks. `rows` of the launch table and `sizes`:
// values, blocks, blocks of blocks.
void planScan(Planner& add, Pass pass, Array array, std::array<std::uint32_t, 2> rows,
              std::array<std::uint32_t, 3> sizes) {
    using enum Array;
    add.onRebuild(pass, "scan_reduce.comp", {array, BlockSums}, rows[0], sizes[0]);
    add.onRebuild(pass, "scan_reduce.comp", {BlockSums, SuperSums}, rows[1], sizes[1]);
    add.onRebuild(pass, "scan_top.comp", {SuperSums}, LAUNCH_ONE, sizes[2]);
    add.onRebuild(pass, "scan_spread.comp", {BlockSums, SuperSums}, rows[1], sizes[1]);
    add.onRebuild(pass, "scan_spread.comp", {array, BlockSums}, rows[0], sizes[0]);
}

void planGrid(Plan& plan, const scene::Scene& scene) {
    using enum Array;
    Planner add(plan);
    const std::uint32_t values = plan.grid.all() + 1;
    const std::uint32_t blocks = blocksOf(values, SCAN_BLOCK);
    const std::uint32_t superBlocks = blocksOf(blocks, SCAN_BLOCK);
    const std::uint32_t owners = plan.spheres + 1;
    const std::uint32_t ownerBlocks = blocksOf(owners, SCAN_BLOCK);
    const std::uint32_t ownerSuperBlocks = blocksOf(ownerBlocks, SCAN_BLOCK);
    plan.fullLaunches = {plan.spheres,  values,       blocks, superBlocks, 1,
                         plan.groups(), MOST_OUTSIDE, owners, ownerBlocks, ownerSuperBlocks};
    const bool remembers = plan.has(History);

    add.always(Pass::Grid, "rebuild_plan.comp", {Counters, FullLaunches, Launches}, 1);
    if (plan.features.sleep)
        add.onRebuild(Pass::Grid, "wake.comp", {Position, Velocity, Before, CellStart, Span, Pairs, Woken},
                      LAUNCH_GROUPS);
    if (remembers) {
        add.onRebuild(Pass::History, "history_clear.comp", {KeptStart}, LAUNCH_OWNERS);
        add.onRebuild(Pass::History, "history_count.comp", {Position, Label, Span, Pairs, History, KeptStart},
                      LAUNCH_GROUPS);
        planScan(add, Pass::History, KeptStart, {LAUNCH_OWNER_BLOCKS, LAUNCH_OWNER_SUPERBLOCKS},
                 {owners, ownerBlocks, ownerSuperBlocks});
        add.onRebuild(Pass::History, "history_keep.comp", {Position, Label, Span, Pairs, History, KeptStart, Kept},
                      LAUNCH_GROUPS);
    }
    add.onRebuild(Pass::Grid, "state_save.comp", {Position, Velocity, Before, Label, Saved, SavedLabel, Woken},
                  LAUNCH_SPHERES);
    add.onRebuild(Pass::Grid, "cell_clear.comp", {CellStart}, LAUNCH_CELLS);
    add.onRebuild(Pass::Grid, "cell_count.comp", {Position, CellStart, Place}, LAUNCH_SPHERES);
    planScan(add, Pass::Grid, CellStart, {LAUNCH_BLOCKS, LAUNCH_SUPERBLOCKS}, {values, blocks, superBlocks});
    add.onRebuild(Pass::Grid, "cell_scatter.comp", {Position, CellStart, Place, Order}, LAUNCH_SPHERES);
    add.onRebuild(Pass::Grid, "cell_order.comp", {CellStart, Order, Label}, LAUNCH_CELLS);
    add.onRebuild(Pass::Grid, "state_gather.comp", {Position, Velocity, Before, Label, Saved, SavedLabel, Order},
                  LAUNCH_SPHERES);
    add.onRebuild(Pass::Grid, "state_anchor.comp", {Position, Label, Anchor, SlotOf, Counters, Order}, LAUNCH_SPHERES);
    if (std::ranges::find(scene.bounds.open, true) != scene.bounds.open.end())
        add.onRebuild(Pass::Lists, "list_outside.comp", {Position, Velocity, Label, Order, Counters, Anchor},
                      LAUNCH_OUTSIDE);
    add.onRebuild(Pass::Lists, "list_build.comp", {Position, CellStart, Counters, Pairs, Span}, LAUNCH_GROUPS);
    add.onRebuild(Pass::Lists, "list_fit.comp", {Counters, Span}, LAUNCH_GROUPS);
    if (remembers)
        add.onRebuild(Pass::History, "history_fetch.comp", {Position, Label, Span, Pairs, History, KeptStart, Kept},
                      LAUNCH_GROUPS);
}

// A kernel over all listed pairs, one colour of groups after the other, level after level.
void planPairs(Plan& plan, Planner& add, Pass pass, std::string_view kernel, const std::vector<Array>& slots) {
    if (!plan.features.contacts) return;
    for (std::uint32_t level = 0; level < plan.grid.levels.size(); ++level)
        for (std::uint32_t colour = 0; colour < 8; ++colour)
            add.always(pass, kernel, slots, plan.grid.levels[level].all() / 64, 8 * level + colour);
}

void planWalls(Plan& plan, Planner& add, Pass pass, std::string_view kernel, const std::vector<Array>& slots) {
    if (plan.features.obstructed()) add.always(pass, kernel, slots, plan.spheres);
}

void planFast(Plan& plan, Planner& add) {
    using enum Array;
    planPairs(plan, add, Pass::Impulses, "solve_impulses.comp",
              {Position, Velocity, Label, CellStart, Span, Pairs, Before, Laws});
    planWalls(plan, add, Pass::WallImpulses, "walls_impulses.comp", {Position, Velocity, Obstacles, Label, Laws, Work});
}

void planBalanced(Plan& plan, Planner& add) {
    using enum Array;
    planPairs(plan, add, Pass::Positions, "solve_positions.comp", {Position, Velocity, CellStart, Span, Pairs, Before});
    planWalls(plan, add, Pass::WallPositions, "walls_positions.comp",
              {Position, Velocity, Before, Obstacles, Label, Laws, Pressed});
    planPairs(plan, add, Pass::Velocities, "solve_velocities.comp",
              {Position, Velocity, Before, Label, CellStart, Span, Pairs, Laws});
    planWalls(plan, add, Pass::WallVelocities, "walls_velocities.comp",
              {Position, Velocity, Before, Obstacles, Label, Laws, Pressed});
    if (!plan.features.friction) return;
    planPairs(plan, add, Pass::Friction, "solve_friction.comp", {Position, Velocity, Label, Span, Pairs, Laws});
    planWalls(plan, add, Pass::WallFriction, "walls_friction.comp",
              {Position, Velocity, Obstacles, Label, Laws, Pressed});
}

void planAccurate(Plan& plan, Planner& add) {
    using enum Array;
    planPairs(plan, add, Pass::Forces, "solve_forces.comp",
              {Position, Velocity, Label, CellStart, Span, Pairs, History, Laws});
    planWalls(plan, add, Pass::WallForces, "walls_forces.comp",
              {Position, Velocity, Obstacles, Label, Laws, WallHistory, Counters});
    if (plan.features.forces()) add.always(Pass::Forces, "apply_forces.comp", {Velocity}, plan.spheres);
}

// The table of contents of a substep.
void planSubstep(Plan& plan, const scene::Scene& scene) {
    using enum Array;
    Planner add(plan);
    const scene::Features& has = plan.features;
    const std::uint32_t n = plan.spheres;

    add.always(Pass::Integrate, "integrate.comp",
               {Position, Velocity, Before, Anchor, Label, Counters, Resting, Obstacles}, n);
    if (has.contacts) {
        planGrid(plan, scene);
        if (has.sleep) {
            add.always(Pass::Sleep, "stir.comp", {Velocity, Anchor, Counters, Stirred, Position}, n);
            add.always(Pass::Sleep, "stir_spread.comp", {Counters, Stirred, Span}, plan.groups());
        }
    }
    const bool impacts = plan.has(Impacts);
    if (impacts) add.whenObserved("velocity_keep.comp", {Velocity, Saved}, n);
    switch (has.model) {
        case scene::Model::Fast:
            planFast(plan, add);
            break;
        case scene::Model::Balanced:
            planBalanced(plan, add);
            break;
        case scene::Model::Accurate:
            planAccurate(plan, add);
            break;
    }
    if (impacts)
        add.whenObserved("statistics_impacts.comp", {Position, Velocity, Saved, Label, Span, Pairs, Laws, Impacts},
                         plan.groups());
    if (has.sleep) add.always(Pass::Sleep, "sleep.comp", {Velocity, Before, Position, Counters}, n);
}

void planOnDemand(Plan& plan) {
    using enum Array;
    plan.statistics.push_back({Pass::Statistics,
                               "statistics_spheres.comp",
                               {Position, Velocity, Obstacles, SphereParts, Label, Laws, WallHistory},
                               blocksOf(plan.spheres, STATISTIC_BLOCK),
                               std::nullopt,
                               0});
    if (!plan.features.contacts) return;
    plan.statistics.push_back({Pass::Statistics,
                               "statistics_contacts.comp",
                               {Position, CellStart, Span, Pairs, Overlaps},
                               plan.groups(),
                               std::nullopt,
                               0});
    if (plan.features.model == scene::Model::Accurate)
        plan.statistics.push_back({Pass::Statistics,
                                   "statistics_springs.comp",
                                   {Position, Velocity, Label, Span, Pairs, History, Laws, Overlaps},
                                   plan.groups(),
                                   std::nullopt,
                                   0});
}

}  // namespace

std::string_view wordsOf(Array array) {
    switch (array) {
        case Array::Position:
        case Array::Velocity:
        case Array::Before:
        case Array::Laws:
        case Array::History:
        case Array::Kept:
        case Array::Pressed:
        case Array::WallHistory:
        case Array::Work:
        case Array::Obstacles:
        case Array::Saved:
        case Array::Anchor:
        case Array::Resting:
        case Array::Overlaps:
        case Array::Impacts:
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

std::uint32_t Plan::pairSections() const {
    if (features.model != scene::Model::Balanced) return 1;
    return features.friction ? 3 : 2;
}

std::uint64_t Plan::bytes() const {
    return std::accumulate(arrays.begin(), arrays.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const ArraySpec& spec) { return sum + spec.bytes; });
}

Plan planFor(const scene::Scene& scene, const scene::Features& features, std::uint32_t spheres, const Radii& radii,
             std::uint32_t pairCapacity) {
    Plan plan;
    plan.features = features;
    plan.spheres = spheres;
    if (features.contacts) {
        plan.grid = gridFor(scene.bounds.max - scene.bounds.min, radii);
        plan.features.levels = plan.grid.levels.size() > 1;
        plan.pairCapacity = pairCapacity != 0 ? pairCapacity : std::max(fewestPairs, pairsPerSphere * spheres);
    }
    if (features.model == scene::Model::Accurate && features.obstructed())
        plan.wallContacts =
            std::min<std::uint32_t>(mostWallContacts, 6 + static_cast<std::uint32_t>(scene.obstacles.size()));
    planArrays(plan, scene);
    planSubstep(plan, scene);
    planOnDemand(plan);
    return plan;
}

}  // namespace spherule::sim
