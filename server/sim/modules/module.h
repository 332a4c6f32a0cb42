#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "sim/features.h"
#include "sim/layout.h"
#include "sim/plan.h"
#include "sim/radius_stats.h"

namespace spherule::sim {

// The stages of a substep, in their order. Within a stage, launches run in the order of the modules that declare them
// (the order of shaders/features.def). The stages from Movers to Restore run only while the lists are rebuilt.
enum class Stage : std::uint8_t {
    Integrate,    // of `fast` and `accurate`
    Rebuild,      // decides whether the lists are rebuilt in this substep
    Movers,       // finds the spheres that get lists of their own
    Leavers,      // wakes sleepers that a neighbour has left; the old lists are still valid
    Carry,        // saves by id what contacts remember
    SortCells,    // the order of the spheres by cell
    SortColumns,  // each column of the spheres, in that order
    Reference,    // positions of the spheres when the lists are built
    Outside,      // distances between the spheres outside the bounds
    Lists,
    Restore,      // gives the new pairs what their contacts remember
    Activity,     // finds the bundles that hold anything that moves
    ContactSums,  // copies the state for the work of contacts
    Begin,        // of `balanced`
    BeforeSolve,  // observed steps only
    Solve,
    Finish,      // of `balanced`: walls and motion
    AfterSolve,  // measures: in observed steps, or in scenes with contact sums
    Sleep,
    Statistics,  // on demand
};

// Collects the arrays and launches that modules declare for one scene.
class PlanBuilder {
  public:
    // `plan` already has its features, numbers and grid; the builder adds arrays and launches. Both must outlive the
    // builder.
    PlanBuilder(Plan& plan, const scene::Scene& scene) : plan_(plan), scene_(scene) {}

    [[nodiscard]] const Plan& plan() const { return plan_; }
    [[nodiscard]] bool has(Feature feature) const { return plan_.features.has(feature); }
    [[nodiscard]] bool hasSurfaces() const { return plan_.features.hasSurfaceFeature(); }

    // Adds arrays to the plan. Each module declares all arrays that it needs; duplicates are ignored.
    void arrays(std::initializer_list<Array> needed);

    // `aliases`: buffers of the kernel whose names differ from the arrays to bind.
    void overSpheres(Stage stage, Pass pass, std::string_view kernel, std::vector<Alias> aliases = {});
    // Runs a work group for each bundle.
    void overBundles(Stage stage, Pass pass, std::string_view kernel);
    // Runs for each STATISTIC_BLOCK spheres.
    void overStatisticBlocks(Stage stage, Pass pass, std::string_view kernel);
    // Runs over all listed pairs: one colour of bundles after the other, level after level, a work group for each
    // bundle. The level of movers is left out while there are none.
    void overPairs(Stage stage, Pass pass, std::string_view kernel);
    // The same while row `row` of the launch table is not empty. `bits` are added to the phase.
    void overPairsIf(Stage stage, Pass pass, std::string_view kernel, std::uint32_t row, std::uint32_t bits = 0);
    // Runs while the lists are rebuilt, a work group for each bundle of a level, level after level.
    void overLevelsOnRebuild(Stage stage, Pass pass, std::string_view kernel);
    void once(Stage stage, Pass pass, std::string_view kernel);
    // Runs once. Its phase is 1 if the launches of a rebuild follow, else 0.
    void decidesRebuild(Stage stage, Pass pass, std::string_view kernel);
    // Runs while the lists are rebuilt. Row `row` of the launch table holds `count` of the launch.
    void onRebuild(Stage stage, Pass pass, std::string_view kernel, std::uint32_t row, std::vector<Alias> aliases = {},
                   std::uint32_t phase = 0);
    // Turns the values of an array into exclusive prefix sums, in blocks and in blocks of blocks. `rows` of the launch
    // table: the row for blocks, then the row for blocks of blocks.
    void prefixSumOnRebuild(Stage stage, Pass pass, Array values, std::array<std::uint32_t, 2> rows,
                            std::uint32_t count);
    // Run in observed steps only.
    void observeSpheres(Stage stage, std::string_view kernel, std::vector<Alias> aliases);
    void observeBundles(Stage stage, std::string_view kernel, std::vector<Alias> aliases);
    // Runs when the length of the substep has changed: parameters.substepRatio is the new one over the old one.
    void onNewSubstepOverPairs(std::string_view kernel);
    void onNewSubstepOverSpheres(std::string_view kernel);
    // Run on demand: over bundles, or over each STATISTIC_BLOCK spheres.
    void statisticsOfBundles(std::string_view kernel, std::vector<Alias> aliases = {});
    void statisticsOfSpheres(std::string_view kernel, std::vector<Alias> aliases = {});
    // Runs at the end of a step.
    void atStepEnd(Pass pass, std::string_view kernel);

    // Adds the launches that sort the columns, and puts arrays and launches in order.
    void finish();

  private:
    struct Staged {
        Stage stage;
        LaunchSpec launch;
    };

    Plan& plan_;
    const scene::Scene& scene_;
    std::vector<Staged> staged_;
};

// The data from which the parameters are computed.
struct ParameterSource {
    const scene::Scene& scene;
    const Plan& plan;
    const RadiusStats& radii;
    double substep;  // s
};

// How `spherule measure` finds the cost of a feature: it compares a bed of equal spheres at rest with and without it.
struct CostComparison {
    std::string_view name{};                   // of its row in the table; empty if the table has no row
    void (*without)(scene::Scene&) = nullptr;  // changes the scene of the bed; nullptr: not at all
    void (*with)(scene::Scene&) = nullptr;
    std::string_view reason{};  // why the table has no row
};

// An optional feature and its contributions to the plan and the parameters.
struct Module {
    Feature feature;
    // Returns true if the scene requires the feature. `others`: the features of the modules before this one.
    bool (*required)(const scene::Scene& scene, const Features& others);
    void (*declare)(PlanBuilder& plan) = nullptr;
    void (*upload)(const ParameterSource& from, layout::Parameters& parameters) = nullptr;
    CostComparison cost{};  // with a name or a reason
};

// One per feature, defined in sim/modules/.
#define FEATURE(flag, Name, text) extern const Module module##Name;
#include "features.def"
#undef FEATURE

// In the order of shaders/features.def.
const std::array<const Module*, featureCount>& modules();

}  // namespace spherule::sim
