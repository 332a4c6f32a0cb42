#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "sim/features.h"
#include "sim/layout.h"
#include "sim/plan.h"
#include "sim/sizes.h"

namespace spherule::sim {

// The stages of a substep, in their order. Within a stage, launches run in the order of the modules that declare them
// (that of shaders/features.def). From Wake to RestoreContacts: only while the lists are rebuilt.
enum class Stage : std::uint8_t {
    Integrate,
    Rebuild,        // decides whether the lists are rebuilt in this substep
    Wake,           // the old lists are there once more
    CarryContacts,  // keeps by id what contacts remember
    SortCells,      // the order of the spheres by cell
    SortColumns,    // each column of the spheres, in that order
    Reference,      // where the spheres are as the lists are built
    Outside,        // how far those outside the bounds are from each other
    Lists,
    RestoreContacts,  // gives the new pairs what their contacts remember
    Activity,         // which cell groups hold anything that moves
    BeforeSolve,      // observed steps only
    Solve,
    Friction,
    AfterSolve,  // observed steps only
    Sleep,
    Statistics,  // on demand
};

// Collects what modules declare for one scene.
class PlanBuilder {
  public:
    // `plan` has its features, numbers and grid, and gets its arrays and launches. Both must outlive the builder.
    PlanBuilder(Plan& plan, const scene::Scene& scene) : plan_(plan), scene_(scene) {}

    [[nodiscard]] const Plan& plan() const { return plan_; }
    [[nodiscard]] bool has(Feature feature) const { return plan_.features.has(feature); }
    [[nodiscard]] bool obstructed() const { return plan_.features.obstructed(); }

    // An array that several modules need is declared by each.
    void arrays(std::initializer_list<Array> wanted);

    // `aliases`: buffers of the kernel that are named otherwise than the array to bind.
    void overSpheres(Stage stage, Pass pass, std::string_view kernel, std::vector<Alias> aliases = {});
    void overGroups(Stage stage, Pass pass, std::string_view kernel);
    // Over all listed pairs, one colour of cell groups after the other, level after level.
    void overPairs(Stage stage, Pass pass, std::string_view kernel);
    void once(Stage stage, Pass pass, std::string_view kernel);
    // While the lists are rebuilt: as many invocations as that row of the launch table says.
    void onRebuild(Stage stage, Pass pass, std::string_view kernel, std::uint32_t row, std::vector<Alias> aliases = {});
    // Turns the values of an array into exclusive prefix sums, in blocks and blocks of blocks; `rows` of the launch
    // table: blocks, blocks of blocks.
    void prefixSumOnRebuild(Stage stage, Pass pass, Array values, std::array<std::uint32_t, 2> rows,
                            std::uint32_t count);
    // In observed steps only.
    void observeSpheres(Stage stage, std::string_view kernel, std::vector<Alias> aliases);
    void observeGroups(Stage stage, std::string_view kernel, std::vector<Alias> aliases);
    // On demand.
    void statistics(std::string_view kernel, std::uint32_t count);

    // Adds the launches that sort the columns, and puts everything in order.
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

// What parameters follow from.
struct ParameterSource {
    const scene::Scene& scene;
    const Plan& plan;
    const Radii& radii;
    double substep;  // s
};

// An optional feature: all that the plan and the parameters know of it.
struct Module {
    Feature feature;
    // Whether the scene requires it; `others` has the features of the modules before it.
    bool (*required)(const scene::Scene& scene, const Features& others);
    void (*declare)(PlanBuilder& plan) = nullptr;
    void (*upload)(const ParameterSource& from, layout::Parameters& parameters) = nullptr;
};

// One per feature, defined in sim/modules/.
#define FEATURE(flag, Name, text) extern const Module module##Name;
#include "features.def"
#undef FEATURE

// In the order of shaders/features.def.
const std::array<const Module*, featureCount>& modules();

}  // namespace spherule::sim
