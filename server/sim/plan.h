#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "sim/array.h"
#include "sim/features.h"
#include "sim/grid.h"
#include "sim/pass.h"
#include "sim/radius_stats.h"

namespace spherule::sim {

struct MeshTables;

// One step in `observedEvery` is observed: it also launches the kernels that only measure how the solver works. The
// number of the step decides, so that every run observes the same steps.
constexpr std::uint64_t observedEvery = 16;

struct ArraySpec {
    Array array{};
    std::uint64_t bytes = 0;
};

// A buffer whose name in the kernel differs from the array to bind, for kernels that work on several arrays.
struct Alias {
    std::string_view buffer;
    Array array{};
};

// Nothing else uses this array between two rebuilds: statistics count in it what each sphere touches.
constexpr Array touchingArray = Array::SortScratchWords;

// The same holds for these two, with the figures that frames carry: the overlap while it is found, then all figures.
constexpr Array deepestArray = Array::RankInCell;
constexpr Array figuresArray = Array::SortScratch;

// Things of which a simulation may get more or fewer.
enum class Varying : std::uint8_t { Nothing, Spheres, StatisticBlocks, PairsTwice };

struct LaunchSpec {
    Pass pass{};
    std::string_view kernel;  // file
    std::uint32_t count = 0;  // invocations; bundles, if the kernel has a work group for each
    std::optional<std::uint32_t> launchRow =
        std::nullopt;  // row of the launch table, for launches of a rebuild, or without lists
    std::uint32_t phase = 0;
    Varying over = Varying::Nothing;  // each has an invocation: `count` follows
    bool decidesRebuild = false;      // `phase` tells whether the launches of a rebuild follow
    bool observing = false;           // only in observed steps
    bool waking = false;              // finds the sleepers that a neighbour wakes
    std::vector<Alias> aliases = {};
};

// All arrays and launches that a scene requires. Made before anything is allocated; nothing else is allocated or
// launched.
struct Plan {
    Features features;
    scene::Model model{};
    std::uint32_t spheres = 0;     // present spheres
    std::uint32_t room = 0;        // spheres for which the arrays have room
    std::uint32_t mostMovers = 0;  // spheres that may have lists of their own (shaders/shared/movers.h); 0: none
    glm::dvec3 periods{};          // m: length of each periodic axis; 0: not periodic
    Grid grid;
    std::uint32_t pairCapacity = 0;
    std::shared_ptr<const MeshTables> meshes{};  // null: the scene has no meshes
    std::uint32_t maxWallHistory = 0;            // remembered by each sphere
    std::vector<ArraySpec> arrays;               // in the order of sim/arrays.def
    std::vector<LaunchSpec> substep;             // in order
    std::vector<LaunchSpec> newSubstep;          // when the length of the substep has changed
    std::vector<LaunchSpec> statistics;          // on demand
    std::vector<LaunchSpec> stepEnd;             // at the end of a step
    std::vector<LaunchSpec> figures;             // when viewers ask for them: the figures of each sphere
    std::vector<LaunchSpec> inspection;          // likewise: what one sphere touches
    std::vector<LaunchSpec> births;              // when emitters look for places
    std::vector<std::uint32_t> dispatchSizes;    // `count` of the launches per row of the launch table

    [[nodiscard]] bool has(Array array) const;
    [[nodiscard]] std::uint64_t bytesOf(Array array) const;
    [[nodiscard]] std::uint64_t bytes() const;
    // Returns the size of an array (bytes), whether the plan has it or not: at least one element.
    [[nodiscard]] std::uint64_t bytesFor(Array array, const scene::Scene& scene) const;
    [[nodiscard]] std::uint32_t groups() const { return grid.all() / 8; }  // of 2 x 2 x 2 cells
    // Sets the number of spheres, within the room, and the launches that depend on it.
    void setSpheres(std::uint32_t count);
    void setPairCapacity(std::uint32_t pairs);
};

// Returns the number of blocks of `block` values that hold `values` values.
constexpr std::uint32_t blocksOf(std::uint32_t values, std::uint32_t block) {
    return (values + block - 1) / block;
}

// `scene` may lack its spheres. `spheres`, `radii`: number and radii of the spheres to simulate. `pairCapacity` 0: the
// default.
Plan planFor(const scene::Scene& scene, const Features& features, std::uint32_t spheres, const RadiusStats& radii,
             std::uint32_t pairCapacity = 0);

// The launches of a substep that is not observed. Each one waits for the one before it.
struct SubstepCost {
    std::uint32_t launches = 0;
    std::uint32_t barriers = 0;
};

// Returns the cost of a substep in which no rebuild of the lists is launched, or one is.
SubstepCost costOf(const Plan& plan, bool rebuild);

// Returns how many batches of pairs may follow one another in a substep. Pairs without a batch come on top.
std::uint32_t mostBatches(const Plan& plan);

// The numbers of a plan that do not follow from its scene.
struct PlanNumbers {
    Features features;
    std::uint32_t spheres = 0;
    std::uint32_t room = 0;
    std::uint32_t pairCapacity = 0;
    std::uint32_t mostMovers = 0;

    template <class Archive>
    void archive(Archive& a) {
        a(features, spheres, room, pairCapacity, mostMovers);
    }
};
PlanNumbers numbersOf(const Plan& plan);
// Returns the plan with these numbers.
Plan planOf(const scene::Scene& scene, const RadiusStats& radii, const PlanNumbers& numbers);

// Returns a plan for a scene with the same spheres as another plan, whose arrays it can take over.
Plan planAsOf(const Plan& other, const scene::Scene& scene, const Features& features, const RadiusStats& radii);

// A part of the memory of a scene, with its name for users.
struct MemoryPart {
    std::string_view name;
    std::uint64_t bytes = 0;
};

// Describe the plan and the memory that it needs. `more`: memory beside the simulation's.
std::string planText(const scene::Scene& scene, const Plan& plan, std::span<const MemoryPart> more);
std::string planJson(const scene::Scene& scene, const Plan& plan, std::span<const MemoryPart> more);

}  // namespace spherule::sim
