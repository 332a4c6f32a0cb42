#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/features.h"
#include "scene/scene.h"
#include "sim/grid.h"
#include "sim/pass.h"
#include "sim/sizes.h"

namespace spherule::sim {

// Device arrays. "Per sphere, in slot order" means cell order where there is a grid, id order elsewhere.
enum class Array : std::uint8_t {
    Position,  // per sphere, in slot order; for `accurate` then what float32 cannot hold of it
    Velocity,  // then, with friction, angular velocities; for `accurate` then what contacts change of both
    Before,    // velocity before the substep, then after impacts; w = time in one place, or CREPT
    Label,     // id and material
    Laws,      // by material and material
    Obstacles,
    CellStart,  // per cell and one more: first slot
    BlockSums,  // of the prefix sum
    SuperSums,
    Place,  // of a sphere in its cell
    Order,
    Saved,  // state while it is put in cell order; in observed steps then velocities before the solver
    SavedLabel,
    Anchor,     // position when the lists were built; w = room outside the bounds
    Resting,    // by id: position when it was last found to have crept
    Woken,      // sleepers to wake at this rebuild
    Stirred,    // per cell group: the last substep in which it held a sphere that was awake
    SlotOf,     // by id
    Pairs,      // listed; for `balanced` then those that touch and, with friction, what presses them
    History,    // of each listed pair
    KeptStart,  // per id and one more: where the contacts that it keeps during a rebuild end
    Kept,
    Pressed,      // per sphere: the pushes of walls in this substep
    WallHistory,  // by id
    Work,         // by id: of pushes out of walls, J
    Span,         // per cell group: first pair, listed, touching, whether it stirs
    Counters,
    FullLaunches,
    Launches,
    SphereParts,  // partial statistics
    Overlaps,
    Impacts,  // per cell group, until they are taken: how many were observed and sums of their speeds
    Count,    // how many arrays there are; not one itself
};

// Every so many steps, one is observed: what only looks at how the solver works is launched too. By the number of the
// step, so that it is the same in every run.
constexpr std::uint64_t observedEvery = 16;

constexpr std::size_t arrayCount = static_cast<std::size_t>(Array::Count);

std::string_view nameOf(Array array);

std::string_view wordsOf(Array array);  // what its words are, as compute::Device::createBuffer wants to know

struct ArraySpec {
    Array array{};
    std::uint64_t bytes = 0;
};

struct LaunchSpec {
    Pass pass{};
    std::string_view kernel;  // file
    std::vector<Array> slots;
    std::uint32_t count = 0;                 // invocations
    std::optional<std::uint32_t> launchRow;  // of the launch table, for launches that only a rebuild needs
    std::uint32_t phase = 0;
    bool observing = false;  // only in observed steps
};

// What a scene requires: made before anything is allocated, and all that is allocated and launched.
struct Plan {
    scene::Features features;
    std::uint32_t spheres = 0;
    Grid grid;
    std::uint32_t pairCapacity = 0;
    std::uint32_t wallContacts = 0;  // that each sphere remembers
    std::vector<ArraySpec> arrays;
    std::vector<LaunchSpec> substep;          // in order
    std::vector<LaunchSpec> statistics;       // on demand
    std::vector<std::uint32_t> fullLaunches;  // invocations per row of the launch table

    [[nodiscard]] bool has(Array array) const;
    [[nodiscard]] std::uint64_t bytesOf(Array array) const;
    [[nodiscard]] std::uint64_t bytes() const;
    // Elements of `Pairs` per listed pair: those listed, those that touch, what presses those.
    [[nodiscard]] std::uint32_t pairSections() const;
    [[nodiscard]] std::uint32_t groups() const { return grid.all() / 8; }  // cell groups of all colours
};

// `scene` without its spheres is enough; radii are those of the spheres to simulate. pairCapacity 0: the default.
Plan planFor(const scene::Scene& scene, const scene::Features& features, std::uint32_t spheres, const Radii& radii,
             std::uint32_t pairCapacity = 0);

// With the memory that it needs.
std::string planText(const scene::Scene& scene, const Plan& plan);
std::string planJson(const scene::Scene& scene, const Plan& plan);

}  // namespace spherule::sim
