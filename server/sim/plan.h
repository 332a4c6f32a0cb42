#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "sim/array.h"
#include "sim/features.h"
#include "sim/grid.h"
#include "sim/pass.h"
#include "sim/sizes.h"

namespace spherule::sim {

// Every so many steps, one is observed: what only looks at how the solver works is launched too. By the number of the
// step, so that it is the same in every run.
constexpr std::uint64_t observedEvery = 16;

struct ArraySpec {
    Array array{};
    std::uint64_t bytes = 0;
};

// A buffer that a kernel names otherwise than the array to bind: kernels that serve several arrays have some.
struct Alias {
    std::string_view buffer;
    Array array{};
};

struct LaunchSpec {
    Pass pass{};
    std::string_view kernel;  // file
    std::uint32_t count = 0;  // invocations
    std::optional<std::uint32_t> launchRow =
        std::nullopt;  // of the launch table, for launches that only a rebuild needs
    std::uint32_t phase = 0;
    bool observing = false;  // only in observed steps
    std::vector<Alias> aliases = {};
};

// What a scene requires: made before anything is allocated, and all that is allocated and launched.
struct Plan {
    Features features;
    scene::Model model{};
    std::uint32_t spheres = 0;
    Grid grid;
    std::uint32_t pairCapacity = 0;
    std::uint32_t wallContacts = 0;           // that each sphere remembers
    std::vector<ArraySpec> arrays;            // in the order of sim/arrays.def
    std::vector<LaunchSpec> substep;          // in order
    std::vector<LaunchSpec> statistics;       // on demand
    std::vector<std::uint32_t> fullLaunches;  // invocations per row of the launch table

    [[nodiscard]] bool has(Array array) const;
    [[nodiscard]] std::uint64_t bytesOf(Array array) const;
    [[nodiscard]] std::uint64_t bytes() const;
    // What an array takes, whether the plan has it or not. At least one element.
    [[nodiscard]] std::uint64_t bytesFor(Array array, const scene::Scene& scene) const;
    [[nodiscard]] std::uint32_t groups() const { return grid.all() / 8; }  // cell groups of all colours
};

// How many blocks of `block` hold so many values.
constexpr std::uint32_t blocksOf(std::uint32_t values, std::uint32_t block) {
    return (values + block - 1) / block;
}

// `scene` without its spheres is enough; radii are those of the spheres to simulate. pairCapacity 0: the default.
Plan planFor(const scene::Scene& scene, const Features& features, std::uint32_t spheres, const Radii& radii,
             std::uint32_t pairCapacity = 0);

// With the memory that it needs.
std::string planText(const scene::Scene& scene, const Plan& plan);
std::string planJson(const scene::Scene& scene, const Plan& plan);

}  // namespace spherule::sim
