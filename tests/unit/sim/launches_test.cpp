// Each launch of a plan covers all invocations of its kernel, whether it has a fixed size or a row of the launch table.
// A kernel of bundles has a work group for each of them on a GPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "compute/cpu/kernels.h"
#include "scene_support.h"
#include "sim/parameters.h"
#include "sim/plan.h"
#include "sim/shaders.h"

namespace spherule::sim {
namespace {

scene::Scene sceneOf(const std::string& model) {
    auto scene = scene::build(scene::testing::parsed(R"({"quality": {"model": ")" + model + R"("},
        "bounds": {"min": [0,0,0], "max": [4,4,4], "open": ["Z_MAX"]},
        "materials": [{"name": "a", "friction": 0.5, "rollingResistance": 0.1}, {"name": "b", "friction": 0.5}],
        "obstacles": [{"plane": {"point": [0,0,1], "normal": [0,0,1]}}, {"box": {"min": [1,1,1], "max": [2,2,2]}}],
        "groups": [{"lattice": {"min": [0.5,2.5,2.5], "max": [3.5,3.5,3.5], "spacing": 0.1, "count": 1000},
                    "radius": {"constant": 0.02}, "material": "a"},
                   {"list": {"spheres": [{"position": [3,1,3]}]}, "radius": {"constant": 0.6}, "material": "b"}]})"));
    EXPECT_TRUE(scene) << scene.error().text();
    return std::move(*scene);
}

std::uint64_t bitsOf(const Features& features) {
    std::uint64_t bits = 0;
    for (const Feature feature : allFeatures())
        if (features.has(feature)) bits |= std::uint64_t{1} << static_cast<unsigned>(feature);
    return bits;
}

TEST(SimLaunches, CoverAllInvocationsOfTheirKernels) {
    for (const char* const model : {"FAST", "BALANCED", "ACCURATE"}) {
        const scene::Scene scene = sceneOf(model);
        const RadiusStats radii = radiusStatsOf(scene);
        const Plan plan = planFor(scene, featuresOf(scene), static_cast<std::uint32_t>(scene.spheres.size()), radii);
        EXPECT_GT(plan.grid.levels.size(), 1U) << "the launches of several levels";
        const layout::Parameters parameters = parametersFor(scene, plan, radii, 1e-3);
        std::vector<LaunchSpec> launches = plan.substep;
        for (const auto* more : {&plan.newSubstep, &plan.statistics, &plan.stepEnd, &plan.figures})
            launches.insert(launches.end(), more->begin(), more->end());
        for (const LaunchSpec& launch : launches) {
            const auto kernels = compute::cpu::floatKernels();
            const auto kernel = std::ranges::find(kernels, launch.kernel, &compute::cpu::Entry::name);
            ASSERT_NE(kernel, kernels.end()) << launch.kernel;
            const std::uint32_t wanted = kernel->count(
                {.slots = {}, .parameters = &parameters, .phase = launch.phase, .features = bitsOf(plan.features)});
            const std::uint32_t launched = launch.launchRow ? plan.dispatchSizes.at(*launch.launchRow) : launch.count;
            EXPECT_GT(wanted, 0U) << launch.kernel;
            EXPECT_GE(launched, wanted) << launch.kernel << " of " << model << ", phase " << launch.phase;
        }
    }
}

}  // namespace
}  // namespace spherule::sim
