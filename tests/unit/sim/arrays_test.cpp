// sim/arrays.def and the kernels declare the same arrays and buffers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string>

#include "compute/cpu/kernels.h"
#include "scene_support.h"
#include "sim/layout.h"
#include "sim/modules/module.h"
#include "sim/pipeline.h"

namespace spherule::sim {
namespace {

using compute::BufferDeclaration;

// Buffers that are bound to different arrays; each launch gives the array.
const std::set<std::string_view> general{"values",  "sums",    "column",       "velocityBeforeSolve", "touching",
                                         "deepest", "figures", "cellOfSphere", "otherOrder"};

bool encodes(std::string_view kernel) {
    return kernel.starts_with("codec_");
}

TEST(SimArrays, EveryBufferOfAKernelIsAnArrayOfItsType) {
    for (const auto& entry : compute::cpu::floatKernels()) {
        if (encodes(entry.name)) continue;
        for (const auto& [type, name] : entry.buffers) {
            if (general.contains(name)) continue;
            const auto array = arrayNamed(name);
            ASSERT_TRUE(array) << entry.name << ": " << name;
            EXPECT_EQ(typeOf(*array).type, type) << entry.name << ": " << name;
        }
    }
}

TEST(SimArrays, EveryArrayIsABufferOfSomeKernel) {
    // These arrays are bound through aliases.
    std::set<std::string_view> used{nameOf(Array::BlockSums), nameOf(Array::SuperSums)};
    for (const auto& [array, kept] : keptArrays) used.insert(nameOf(kept));  // the device only copies to them
    for (const auto& entry : compute::cpu::floatKernels())
        for (const auto& declared : entry.buffers) used.insert(declared.name);
    for (std::size_t k = 0; k < arrayCount; ++k)
        EXPECT_TRUE(used.contains(nameOf(static_cast<Array>(k)))) << nameOf(static_cast<Array>(k));
}

TEST(SimArrays, EveryColumnOfTheStateHasAnArrayOfItsType) {
    forEachColumn([]<class T>(std::vector<T> SphereColumns::*, Array array) {
        const ArrayType& type = typeOf(array);
        EXPECT_EQ(type.elementBytes, sizeof(T)) << type.name;
        EXPECT_EQ(type.extent, Extent::Sphere) << type.name;
        EXPECT_TRUE(type.sorted && type.cleared && !type.byId) << type.name;
    });
}

TEST(SphereColumns, AppendedStatesHaveAllColumns) {
    State state;
    State more;
    std::size_t columns = 0;
    forEachColumn([&]<class T>(std::vector<T> SphereColumns::*column, Array) {
        (state.*column).assign(2, T(1));
        (more.*column).assign(3, T(2));
        ++columns;
    });
    EXPECT_GE(columns, 3U);
    more.images.resize(3);
    state.append(more);
    EXPECT_EQ(state.count(), 5U);
    EXPECT_EQ(state.images.size(), 3U);
    forEachColumn([&]<class T>(std::vector<T> SphereColumns::*column, Array) {
        EXPECT_EQ(state.*column, (std::vector<T>{T(1), T(1), T(2), T(2), T(2)}));
    });
}

class FakeKernel final : public compute::Kernel {
  public:
    explicit FakeKernel(std::vector<BufferDeclaration> buffers) : buffers_(std::move(buffers)) {}
    [[nodiscard]] const std::string& name() const override { return name_; }
    [[nodiscard]] std::span<const BufferDeclaration> buffers() const override { return buffers_; }

  private:
    std::string name_ = "fake.comp";
    std::vector<BufferDeclaration> buffers_;
};

std::string refusalOf(std::vector<BufferDeclaration> buffers, std::vector<Alias> aliases = {}) {
    const LaunchSpec launch{.pass = Pass::Integrate, .kernel = "fake.comp", .aliases = std::move(aliases)};
    const auto bound = arraysFor(launch, FakeKernel(std::move(buffers)));
    return bound ? "" : bound.error().text();
}

TEST(SimArrays, AreBoundByNameInAnyOrder) {
    const LaunchSpec launch{.pass = Pass::Integrate, .kernel = "fake.comp", .aliases = {{"values", Array::CellStart}}};
    const auto bound = arraysFor(launch, FakeKernel({{"vec4", "velocity"}, {"uint", "values"}, {"vec4", "position"}}));
    ASSERT_TRUE(bound);
    EXPECT_EQ(*bound, (std::vector<Array>{Array::Velocity, Array::CellStart, Array::Position}));
}

TEST(SimArrays, InvalidBindingsAreRefusedWithAMessage) {
    EXPECT_EQ(refusalOf({{"vec4", "postion"}}),
              "fake.comp: declares the buffer postion, but sim/arrays.def has no array of that name");
    EXPECT_EQ(refusalOf({{"uint", "position"}}),
              "fake.comp: declares the buffer position as uint; the array position has elements of type vec4");
    // Two arrays are swapped.
    EXPECT_EQ(refusalOf({{"uint", "values"}, {"vec4", "column"}},
                        {{"values", Array::Velocity}, {"column", Array::CellStart}}),
              "fake.comp: declares the buffer values as uint; the array velocity has elements of type vec4");
    EXPECT_EQ(refusalOf({{"vec4", "position"}}, {{"positions", Array::Velocity}}),
              "fake.comp: is launched with an alias for positions, which it does not declare");
}

TEST(SimLayout, WordsAreReadFromTheSource) {
    EXPECT_EQ(layout::wordsOf("ContactParams"), "rrrrrrrr");
    EXPECT_EQ(layout::wordsOf("Obstacle"), "rrrrrrrrrrrrrrrrrrrruuuuuuuu");
    EXPECT_EQ(layout::wordsOf("Parameters").size() * 4, sizeof(layout::Parameters));
    EXPECT_EQ(layout::wordsOf("SphereStatistics").size() * 4, sizeof(layout::SphereStatistics));
    EXPECT_EQ(layout::wordsOf("Parameters", "codec_layout.h"), "rrrrrrrrrrrruuuuuuuuuuuuuuuu");
    EXPECT_THROW(layout::wordsOf("Nothing"), std::logic_error);
    EXPECT_EQ(layout::wordsOf("Parameters").find('u') * 4, offsetof(layout::Parameters, cells));
    const auto word = [](std::size_t offset) { return layout::wordsOf("Parameters").at(offset / 4); };
    EXPECT_EQ(word(offsetof(layout::Parameters, spheres) - 4), 'r');
    EXPECT_EQ(word(offsetof(layout::Parameters, spheres)), 'u');
    EXPECT_EQ(word(offsetof(layout::Parameters, perImpulseUnit) - 4), 'u');
    EXPECT_EQ(word(offsetof(layout::Parameters, perImpulseUnit)), 'r');
}

// A plan without one feature has no arrays or launches that only this feature's module declares.
TEST(SimModules, AreAbsentFromAPlanThatDoesNotRequireThem) {
    for (const char* const model : {"FAST", "BALANCED", "ACCURATE"}) {
        const auto scene =
            scene::build(scene::testing::parsed(std::string(R"({"quality": {"model": ")") + model + R"("},
            "bounds": {"min": [0,0,0], "max": [4,4,4], "open": ["Z_MAX"]},
            "materials": [{"name": "a", "friction": 0.5, "rollingResistance": 0.1}, {"name": "b", "friction": 0.5}],
            "obstacles": [{"plane": {"point": [0,0,1], "normal": [0,0,1]}}, {"box": {"min": [1,1,1], "max": [2,2,2]}}],
            "groups": [{"list": {"spheres": [{"position": [3,3,3]}]}, "radius": {"constant": 0.1}, "material": "a"},
                       {"list": {"spheres": [{"position": [3,2,3]}]}, "radius": {"constant": 0.2}, "material": "b"}]})"));
        ASSERT_TRUE(scene) << scene.error().text();
        const auto planWith = [&](const Features& features) {
            return planFor(*scene, features, 2, radiusStatsOf(*scene));
        };
        const Features all = featuresOf(*scene);
        const Plan whole = planWith(all);
        for (const Module* module : modules()) {
            const bool isModel = module->feature == Feature::Fast || module->feature == Feature::Balanced ||
                                 module->feature == Feature::Accurate;
            if (!all.has(module->feature) || module->declare == nullptr || isModel) continue;
            Features fewer;
            for (const Module* other : modules())
                fewer.set(other->feature, other != module && other->required(*scene, fewer));
            const Plan plan = planWith(fewer);
            const bool smaller = plan.bytes() < whole.bytes() || plan.substep.size() < whole.substep.size();
            // Walls and obstacles share all arrays and launches, so the plan is not smaller without one of them.
            if (!all.hasSurfaceFeature() ||
                (module->feature != Feature::Walls && module->feature != Feature::Planes &&
                 module->feature != Feature::Boxes && module->feature != Feature::Materials)) {
                EXPECT_TRUE(smaller) << nameOf(module->feature) << " of " << model;
            }
            for (const ArraySpec& spec : plan.arrays) EXPECT_TRUE(whole.has(spec.array)) << nameOf(spec.array);
        }
    }
}

}  // namespace
}  // namespace spherule::sim
