#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "compute/device.h"
#include "core/memory.h"
#include "scene/load.h"
#include "sim/memory_needs.h"
#include "sim/simulation.h"

namespace spherule::sim {
namespace {

constexpr std::uint64_t mebi = 1U << 20U;

v1::Scene latticeOf(std::uint32_t count, double friction) {
    v1::Scene scene;
    constexpr double spacing = 0.11;
    const double side = spacing * (std::ceil(std::cbrt(count)) + 1);
    for (int axis = 0; axis < 3; ++axis) {
        scene.mutable_bounds()->add_min(0);
        scene.mutable_bounds()->add_max(side);
    }
    scene.add_materials()->set_friction(friction);
    scene.mutable_quality()->set_model(v1::BALANCED);
    v1::Group& group = *scene.add_groups();
    group.mutable_radius()->set_constant(0.05);
    v1::Lattice& lattice = *group.mutable_lattice();
    for (int axis = 0; axis < 3; ++axis) {
        lattice.add_min(0);
        lattice.add_max(side);
    }
    lattice.set_spacing(spacing);
    lattice.set_count(count);
    return scene;
}

// Memory of this process (bytes): held() at present, mostHeld() at its peak.
std::uint64_t held() {
    malloc_trim(0);  // returns freed memory to the system
    std::ifstream file("/proc/self/statm");
    std::uint64_t size = 0;
    std::uint64_t resident = 0;
    file >> size >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}
std::uint64_t mostHeld() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

class SimMemory : public testing::Test {
  protected:
    ~SimMemory() override { memory::setLimit(0); }
    std::unique_ptr<compute::Device> device_ = std::move(*compute::openDevice("cpu:1"));
};

TEST_F(SimMemory, ClaimedMemoryMatchesAllocatedMemory) {
    for (const double friction : {0.0, 0.3}) {
        auto scene = scene::build(latticeOf(200'000, friction));
        ASSERT_TRUE(scene) << scene.error().text();
        const std::uint64_t before = held() - 200'000 * sizeof(scene::Sphere);
        auto simulation = Simulation::create(*device_, std::move(*scene));
        ASSERT_TRUE(simulation) << simulation.error().text();
        ASSERT_TRUE((*simulation)->step());
        const MemoryNeeds need = memoryNeedsOf((*simulation)->plan());
        const auto stays = static_cast<double>(need.arrays + need.onHost());
        EXPECT_GT(stays, 0.9 * static_cast<double>(held() - before)) << "friction " << friction;
        EXPECT_LT(stays, 1.3 * static_cast<double>(held() - before)) << "friction " << friction;
        EXPECT_EQ(memory::claimed().held, need.arrays + need.onHost());
        EXPECT_EQ(memory::claimed().promised, need.temporary);
    }
    EXPECT_EQ(memory::claimed().held + memory::claimed().promised, 0U);
}

// This test has more spheres than the others, so that an earlier peak does not hide its own peak.
TEST_F(SimMemory, SceneIsBuiltWithoutASecondCopyOfItsSpheres) {
    constexpr std::uint32_t spheres = 4'000'000;
    const std::uint64_t before = held();
    const auto scene = scene::build(latticeOf(spheres, 0.3));
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_LT(mostHeld(), before + 13 * std::uint64_t{spheres} * sizeof(scene::Sphere) / 10);
}

TEST_F(SimMemory, TooLargeSceneIsRefusedBeforeAllocation) {
    memory::setLimit(held() + 100 * mebi);
    const std::uint64_t before = mostHeld();
    const auto scene = scene::build(latticeOf(16'000'000, 0));
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().kind, ErrorKind::Refused);
    EXPECT_EQ(scene.error().where, "groups[0].lattice.count");
    EXPECT_NE(scene.error().message.find("854 MiB more of memory are needed"), std::string::npos)
        << scene.error().message;
    EXPECT_LT(mostHeld(), before + 20 * mebi);
}

TEST_F(SimMemory, TooLargeSimulationIsRefusedBeforeAllocation) {
    auto scene = scene::build(latticeOf(400'000, 0));
    ASSERT_TRUE(scene);
    memory::setLimit(held() + 150 * mebi);
    const std::uint64_t before = mostHeld();
    const auto refused = Simulation::create(*device_, std::move(*scene));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Refused);
    EXPECT_NE(refused.error().text().find("more of memory are needed for a scene of 400000 spheres"), std::string::npos)
        << refused.error().text();
    EXPECT_LT(mostHeld(), before + 20 * mebi);
    EXPECT_EQ(memory::claimed().promised, 0U);
}

TEST_F(SimMemory, OldAndNewSimulationCountDuringReplacement) {
    auto scene = scene::build(latticeOf(200'000, 0));
    ASSERT_TRUE(scene);
    const auto running = Simulation::create(*device_, std::move(*scene));
    ASSERT_TRUE(running);
    auto next = scene::build(latticeOf(200'000, 0));
    ASSERT_TRUE(next);
    memory::setLimit(held() + 60 * mebi);
    const auto refused = Simulation::create(*device_, std::move(*next));
    ASSERT_FALSE(refused);
    const std::string holds = "what runs here holds " + memory::sizeText(memory::claimed().held);
    EXPECT_NE(refused.error().text().find(holds), std::string::npos) << refused.error().text();
    EXPECT_TRUE((*running)->step()) << "it goes on";
}

TEST_F(SimMemory, CommandsWithoutMemoryAreRefusedAndChangeNothing) {
    auto scene = scene::build(latticeOf(100'000, 0));
    ASSERT_TRUE(scene);
    const auto simulation = Simulation::create(*device_, std::move(*scene));
    ASSERT_TRUE(simulation);
    ASSERT_TRUE((*simulation)->step());
    Spawn spawn;
    spawn.place = [group = latticeOf(1, 0).groups(0)](const scene::Scene& to, Progress& progress) {
        return scene::buildGroup(group, to, &progress);
    };
    for (const Command& command : {Command(Reset()), Command(Set{.friction = 0.3}), Command(spawn)}) {
        memory::setLimit(held());
        const auto refused = (*simulation)->apply(command);
        memory::setLimit(0);
        ASSERT_FALSE(refused) << command.index();
        EXPECT_EQ(refused.error().kind, ErrorKind::Refused);
        EXPECT_NE(refused.error().text().find("more of memory are needed"), std::string::npos)
            << refused.error().text();
    }
    EXPECT_EQ((*simulation)->steps(), 1U);
    EXPECT_EQ((*simulation)->count(), 100'000U);
    EXPECT_TRUE((*simulation)->apply(Reset())) << "with room it goes";
}

}  // namespace
}  // namespace spherule::sim
