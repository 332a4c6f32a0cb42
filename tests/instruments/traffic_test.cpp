// The memory that a substep of a settled bed moves, counted by the instrument, is what the plan says.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "faulty.h"
#include "races.h"
#include "scene/load.h"
#include "scene/quality.h"
#include "sim/traffic.h"
#include "support.h"
#include "work_groups.h"

namespace spherule::instruments {
namespace {

using support::valueOf;

struct BedCase {
    std::string name;
    const char* scene = "";
    scene::Model model{};
    double friction = 0;
    scene::Model settledIn{};
    double mostBytes = 0;  // per sphere and substep
};

std::ostream& operator<<(std::ostream& out, const BedCase& one) {
    return out << one.name;
}

// The bytes per sphere and substep of a kernel and a buffer.
struct Row {
    double read = 0;
    double written = 0;
    double sectors = 0;
};

struct Counted {
    sim::Plan plan;
    std::map<std::pair<std::string, std::string>, Row> rows;  // by kernel and buffer
};

bool isOfEachSubstep(const sim::Plan& plan, const std::string& kernel) {
    return std::ranges::any_of(plan.substep, [&](const sim::LaunchSpec& launch) {
        return launch.kernel == kernel && !launch.launchRow && !launch.observing;
    });
}

// Settles a bed with the kernels of the program. Then counts the kernels that each substep launches.
Counted countedIn(const BedCase& one) {
    const auto bedIn = [&](scene::Model model) {
        scene::Scene scene = valueOf(scene::load(one.scene, "cpu", {.model = model}));
        scene.sleep.enabled = false;
        for (scene::Material& material : scene.materials) material.friction = one.friction;
        return scene;
    };
    const scene::Scene scene = bedIn(one.model);
    sim::State state = sim::stateOf(scene);
    // `accurate` would take long to settle.
    for (const auto& [model, seconds] : {std::pair(one.settledIn, 3.0), {one.model, 0.1}}) {
        const auto device = valueOf(compute::openDevice("cpu"));
        const auto simulation = physics::simulate(bedIn(model), *device);
        simulation->upload(state);
        physics::run(*simulation, seconds);
        state = simulation->snapshot();
    }
    const Chosen chosen(inWorkGroups());
    const auto device = valueOf(compute::openDevice("cpu:1x1"));
    const auto simulation = physics::simulate(scene, *device);
    simulation->upload(state);
    for (int k = 0; k < 16; ++k) valueOf(simulation->advance());
    takeTraffic();
    constexpr int substeps = 8;
    for (int k = 0; k < substeps; ++k) valueOf(simulation->advance());
    const double times = substeps * static_cast<double>(scene.spheres.size());
    Counted counted{.plan = simulation->plan(), .rows = {}};
    for (const Traffic& row : takeTraffic())
        if (isOfEachSubstep(counted.plan, row.kernel))
            counted.rows[{row.kernel, row.buffer}] = {
                static_cast<double>(row.bytesRead) / times, static_cast<double>(row.bytesWritten) / times,
                static_cast<double>(row.sectorBytesRead + row.sectorBytesWritten) / times};
    takeRaces();
    return counted;
}

class TrafficOf : public testing::TestWithParam<BedCase> {};

TEST_P(TrafficOf, ASettledBedIsWhatThePlanSays) {
    const Counted counted = countedIn(GetParam());
    const std::vector<sim::Traffic> planned = sim::trafficOf(counted.plan, sim::bedMeansOf(counted.plan.model));
    double words = 0;
    double sectors = 0;
    for (const auto& [key, row] : counted.rows) {
        const auto& [kernel, buffer] = key;
        words += row.read + row.written;
        sectors += row.sectors;
        if (row.read + row.written >= 0.5)
            fmt::print("{:<26}{:<18}{:>6.1f}{:>8.1f}\n", kernel, buffer, row.read, row.written);
        const auto found = std::ranges::find_if(
            planned, [&](const sim::Traffic& one) { return one.kernel == kernel && sim::nameOf(one.array) == buffer; });
        const sim::Traffic expected = found == planned.end() ? sim::Traffic{} : *found;
        // Spheres at walls have no rows, and a bed of few spheres has many of them.
        EXPECT_NEAR(row.read, expected.read, 5 + 0.15 * expected.read) << kernel << " reads " << buffer;
        EXPECT_NEAR(row.written, expected.written, 5 + 0.15 * expected.written) << kernel << " writes " << buffer;
    }
    double all = 0;
    for (const sim::Traffic& one : planned) {
        all += one.read + one.written;
        EXPECT_TRUE(counted.rows.contains({std::string(one.kernel), std::string(sim::nameOf(one.array))}))
            << one.kernel << " does not access " << sim::nameOf(one.array);
    }
    fmt::print("{}: {:.0f} bytes per sphere and substep, {:.0f} in sectors; planned: {:.0f}\n", GetParam().name, words,
               sectors, all);
    EXPECT_NEAR(words, all, 0.12 * all);
    EXPECT_LE(words, GetParam().mostBytes);
}

INSTANTIATE_TEST_SUITE_P(
    Of, TrafficOf,
    testing::Values(BedCase{"fast", "box-4k", scene::Model::Fast, 0.3, scene::Model::Fast, 420},
                    BedCase{"balanced", "box-10k", scene::Model::Balanced, 0.3, scene::Model::Balanced, 600},
                    BedCase{"balanced_without_friction", "box-10k", scene::Model::Balanced, 0, scene::Model::Balanced,
                            400},
                    BedCase{"accurate", "box-4k", scene::Model::Accurate, 0.3, scene::Model::Balanced, 640}),
    [](const auto& parameter) { return parameter.param.name; });

// A launch reads a word once however often it is read, and does not read what it has written.
TEST(TrafficControl, CountsEachWordOfALaunchOnce) {
    const Chosen chosen(inWorkGroups());
    takeTraffic();
    launchControl("reads_neighbour");
    const std::vector<Traffic> rows = takeTraffic();
    takeRaces();
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].buffer, "values");
    EXPECT_EQ(rows[0].bytesRead, 63 * 4U);  // word 0 is written before it is read
    EXPECT_EQ(rows[0].bytesWritten, 64 * 4U);
    EXPECT_GE(rows[0].sectorBytesWritten, 64 * 4U);
    EXPECT_LE(rows[0].sectorBytesWritten, 64 * 4U + 32U);  // the buffer may begin within a sector
}

}  // namespace
}  // namespace spherule::instruments
