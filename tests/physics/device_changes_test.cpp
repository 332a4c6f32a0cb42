// Changes of a scene that need kernels which were not compiled, while the world goes on, on each device.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "part_support.h"

namespace spherule::physics {
namespace {

using support::valueOf;

// Changes of a falling box, of which at least one needs other kernels.
struct Edits {
    std::string name;
    Model model{};
    std::vector<sim::Command> commands;
    sim::Feature feature{};  // of the kernels after the first change
    bool stays = false;      // until the last change
};

std::ostream& operator<<(std::ostream& out, const Edits& edits) {
    return out << edits.name;
}

constexpr const char* materials = R"({"name": "oak", "friction": 0.3}, {"name": "cork", "density": 240})";

std::vector<Edits> allEdits() {
    const auto changeGroup = change<v1::ChangeGroup>(R"({"number": 1, "material": "cork"})");
    return {{"a_field", Model::Balanced, {addField(fields[1]), removeField(0)}, sim::Feature::Flows, false},
            {"an_emitter",
             Model::Balanced,
             {change<v1::AddEmitter>(fmt::format(R"({{"emitter": {}}})", jet)),
              change<v1::RemoveEmitter>(R"({"number": 0})")},
             sim::Feature::Radii,
             true},
            {"materials",
             Model::Balanced,
             {changeGroup, change<v1::ChangeMaterial>(R"({"number": 1, "material": {"name": "cork", "friction": 0.5,
                                             "rollingResistance": 0.05}})"),
              sim::RemoveGroup{0}},
             sim::Feature::Materials,
             true},
            {"fast", Model::Fast, {addField(fields[4]), changeGroup}, sim::Feature::Springs, true}};
}

class DeviceChanges : public testing::TestWithParam<Edits> {};

INSTANTIATE_TEST_SUITE_P(Of, DeviceChanges, testing::ValuesIn(allEdits()),
                         [](const auto& one) { return one.param.name; });

struct Seen {
    std::vector<unsigned> substeps;       // while the kernels of each change were made
    std::vector<std::uint64_t> hashes;    // when each change begins to hold, and two steps later
    std::vector<sim::Features> features;  // then

    bool operator==(const Seen&) const = default;
};

// Does a substep after each piece of the change, with the kernels from before. Returns their number.
unsigned changeOnTheWay(sim::Simulation& simulation, const sim::Command& command) {
    auto outcome = valueOf(simulation.begin(command));
    if (!outcome.preparation) return 0;
    EXPECT_TRUE(outcome.preparation->letsStep());
    const sim::Features before = simulation.plan().features;
    unsigned substeps = 0;
    while (!valueOf(outcome.preparation->advance())) {
        if (!outcome.preparation->letsStep()) continue;
        valueOf(simulation.advance());
        ++substeps;
    }
    EXPECT_EQ(simulation.plan().features, before);
    const std::uint64_t hash = sim::hashOf(simulation.snapshot());
    simulation.adopt(std::move(outcome.preparation));
    EXPECT_EQ(sim::hashOf(simulation.snapshot()), hash);
    return substeps;
}

scene::Scene boxOf(const Edits& edits) {
    return fallingBox(edits.model, "", materials);
}

Seen seenOn(const char* choice, const Edits& edits) {
    const auto device = valueOf(compute::openDevice(choice));
    auto simulation = simulate(boxOf(edits), *device);
    run(*simulation, 4 * simulation->scene().step);
    Seen seen;
    for (const sim::Command& command : edits.commands) {
        seen.substeps.push_back(changeOnTheWay(*simulation, command));
        seen.hashes.push_back(sim::hashOf(simulation->snapshot()));
        seen.features.push_back(simulation->plan().features);
        run(*simulation, 2 * simulation->scene().step);
        seen.hashes.push_back(sim::hashOf(simulation->snapshot()));
    }
    return seen;
}

TEST_P(DeviceChanges, WaitForTheirKernelsInSoftwareAsWell) {
    const Seen expected = seenOn("cpu:1x1", GetParam());
    EXPECT_GT(expected.substeps[0], 20U) << "kernels had to be made";
    EXPECT_TRUE(expected.features.front().has(GetParam().feature));
    EXPECT_EQ(expected.features.back().has(GetParam().feature), GetParam().stays);
    // Until the first change holds, nothing differs from a world without it.
    auto plain = simulate(boxOf(GetParam()));
    run(*plain, 4 * plain->scene().step);
    for (unsigned k = 0; k < expected.substeps[0]; ++k) valueOf(plain->advance());
    EXPECT_EQ(sim::hashOf(plain->snapshot()), expected.hashes[0]);
    const Seen seen = seenOn("software", GetParam());
    EXPECT_EQ(seen.substeps, expected.substeps);
    EXPECT_EQ(seen.hashes, expected.hashes);
    EXPECT_EQ(seen.features, expected.features);
}

}  // namespace
}  // namespace spherule::physics
