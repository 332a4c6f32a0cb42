#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/cgroup.h"
#include "core/memory.h"

namespace spherule::memory {
namespace {

namespace fs = std::filesystem;

class ControlGroup : public testing::Test {
  protected:
    ~ControlGroup() override { fs::remove_all(root_); }
    void file(const std::string& path, const std::string& text) const {
        fs::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << text;
    }
    // Memory (bytes) that the control groups still allow.
    [[nodiscard]] std::optional<std::uint64_t> room() const {
        const auto found = roomInControlGroup(root_);
        return found ? std::optional(found->left) : std::nullopt;
    }

    fs::path root_ = fs::temp_directory_path() / ("spherule_cgroup_" + std::to_string(getpid()));
};

TEST_F(ControlGroup, WithoutLimitIsNullopt) {
    EXPECT_FALSE(room());
    file("proc/self/cgroup", "0::/\n");
    file("sys/fs/cgroup/memory.max", "max\n");
    file("sys/fs/cgroup/memory.current", "5000\n");
    EXPECT_FALSE(room());
}

TEST_F(ControlGroup, Version2SubtractsUsedMemory) {
    file("proc/self/cgroup", "0::/\n");
    file("sys/fs/cgroup/memory.max", "10000\n");
    file("sys/fs/cgroup/memory.current", "7000\n");
    EXPECT_EQ(room(), 3000U);
    file("sys/fs/cgroup/memory.stat", "anon 5000\ninactive_file 2000\nfile 2500\n");
    EXPECT_EQ(room(), 5000U);
    file("sys/fs/cgroup/memory.current", "12000\n");
    EXPECT_EQ(room(), 0U);
}

TEST_F(ControlGroup, LeastRoomOfTheGroupsCounts) {
    file("proc/self/cgroup", "0::/outer/inner\n");
    file("sys/fs/cgroup/outer/memory.max", "4000\n");
    file("sys/fs/cgroup/outer/memory.current", "1000\n");
    file("sys/fs/cgroup/outer/inner/memory.max", "9000\n");
    file("sys/fs/cgroup/outer/inner/memory.current", "500\n");
    EXPECT_EQ(room(), 3000U);
}

TEST_F(ControlGroup, Version1IsRead) {
    file("proc/self/cgroup", "5:cpu:/a\n4:memory:/docker/1f\n");
    file("sys/fs/cgroup/memory/memory.limit_in_bytes", "8000\n");  // the root group, as seen in a container
    file("sys/fs/cgroup/memory/memory.usage_in_bytes", "3000\n");
    file("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 1000\n");
    EXPECT_EQ(room(), 6000U);
}

TEST_F(ControlGroup, LimitIsTheLesserOfMachineAndGroup) {
    file("proc/meminfo", "MemTotal: 8000 kB\nMemFree: 100 kB\nMemAvailable:    6000 kB\n");
    EXPECT_EQ(memory::room(root_).left, 6000U * 1024);
    EXPECT_EQ(memory::room(root_).limit, 8000U * 1024);
    EXPECT_STREQ(memory::room(root_).whose, "the machine has");
    file("proc/self/cgroup", "0::/\n");
    file("sys/fs/cgroup/memory.max", "4096000\n");
    file("sys/fs/cgroup/memory.current", "1000000\n");
    EXPECT_EQ(memory::room(root_).left, 3096000U);
    EXPECT_EQ(memory::room(root_).limit, 4096000U);
    EXPECT_STREQ(memory::room(root_).whose, "its control group allows");
    file("proc/meminfo", "MemTotal: 8000 kB\nMemAvailable: 2000 kB\n");
    EXPECT_EQ(memory::room(root_).left, 2000U * 1024) << "others on the machine hold the rest";
}

constexpr std::uint64_t mebi = 1U << 20U;

// Limits this process to 1 GiB.
class Claims : public testing::Test {
  protected:
    Claims() { setLimit(1024 * mebi); }
    ~Claims() override { setLimit(0); }
};

TEST_F(Claims, ReducesTheFreeMemory) {
    auto first = Claim::make("load", "a scene", 600 * mebi);
    ASSERT_TRUE(first) << first.error().text();
    EXPECT_EQ(claimed().promised, 600 * mebi);
    const auto second = Claim::make("load", "another scene", 600 * mebi);
    ASSERT_FALSE(second) << "though no page of the first has been touched";
    EXPECT_EQ(second.error().kind, ErrorKind::Refused);
    *first = {};
    EXPECT_EQ(claimed().promised, 0U);
    EXPECT_TRUE(Claim::make("load", "another scene", 600 * mebi));
}

TEST_F(Claims, RefusalStatesNeededHeldAndLimit) {
    auto world = Claim::make("load", "a scene", 300 * mebi);
    ASSERT_TRUE(world);
    world->settle(300 * mebi, 0);
    const auto refused = Claim::make("load", "a scene of 9 spheres", 2000 * mebi);
    ASSERT_FALSE(refused);
    for (const char* const part : {"load: 1.95 GiB more", "a scene of 9 spheres", "--memory-limit allows 1.00 GiB",
                                   "what runs here holds 300 MiB", "use fewer spheres"})
        EXPECT_NE(refused.error().text().find(part), std::string::npos) << part << " in: " << refused.error().text();
}

TEST_F(Claims, AreMovable) {
    {
        Claim held;
        {
            auto made = Claim::make("", "a scene", 100 * mebi);
            ASSERT_TRUE(made);
            held = std::move(*made);
        }
        EXPECT_EQ(claimed().promised, 100 * mebi);
        held.settle(70 * mebi, 30 * mebi);
        EXPECT_EQ(claimed().held, 70 * mebi);
        EXPECT_EQ(claimed().promised, 30 * mebi);
    }
    EXPECT_EQ(claimed().held, 0U);
    EXPECT_EQ(claimed().promised, 0U);
}

TEST_F(Claims, SmallOnesAreAlwaysGranted) {
    const auto all = Claim::make("", "a scene", 900 * mebi);
    setLimit(mebi);
    EXPECT_TRUE(Claim::make("", "a few spheres", mebi / 2));
    EXPECT_FALSE(Claim::make("", "many spheres", 2 * mebi));
}

}  // namespace
}  // namespace spherule::memory
