#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compute/cpu/cgroup.h"

namespace spherule::compute::cpu {
namespace {

namespace fs = std::filesystem;

class ControlGroup : public testing::Test {
  protected:
    ~ControlGroup() override { fs::remove_all(root_); }
    void file(const std::string& path, const std::string& text) const {
        fs::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << text;
    }
    [[nodiscard]] std::optional<std::size_t> room() const { return roomInControlGroup(root_); }

    fs::path root_ = fs::temp_directory_path() / ("spherule_cgroup_" + std::to_string(getpid()));
};

TEST_F(ControlGroup, WithoutALimitThereIsNone) {
    EXPECT_FALSE(room());
    file("proc/self/cgroup", "0::/\n");
    file("sys/fs/cgroup/memory.max", "max\n");
    file("sys/fs/cgroup/memory.current", "5000\n");
    EXPECT_FALSE(room());
}

TEST_F(ControlGroup, Version2LeavesWhatIsNotHeld) {
    file("proc/self/cgroup", "0::/\n");
    file("sys/fs/cgroup/memory.max", "10000\n");
    file("sys/fs/cgroup/memory.current", "7000\n");
    EXPECT_EQ(room(), 3000U);
    file("sys/fs/cgroup/memory.stat", "anon 5000\ninactive_file 2000\nfile 2500\n");
    EXPECT_EQ(room(), 5000U);
    file("sys/fs/cgroup/memory.current", "12000\n");
    EXPECT_EQ(room(), 0U);
}

TEST_F(ControlGroup, TheNarrowestOfTheGroupsCounts) {
    file("proc/self/cgroup", "0::/outer/inner\n");
    file("sys/fs/cgroup/outer/memory.max", "4000\n");
    file("sys/fs/cgroup/outer/memory.current", "1000\n");
    file("sys/fs/cgroup/outer/inner/memory.max", "9000\n");
    file("sys/fs/cgroup/outer/inner/memory.current", "500\n");
    EXPECT_EQ(room(), 3000U);
}

TEST_F(ControlGroup, Version1IsReadToo) {
    file("proc/self/cgroup", "5:cpu:/a\n4:memory:/docker/1f\n");
    file("sys/fs/cgroup/memory/memory.limit_in_bytes", "8000\n");  // what a container sees as its root
    file("sys/fs/cgroup/memory/memory.usage_in_bytes", "3000\n");
    file("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 1000\n");
    EXPECT_EQ(room(), 6000U);
}

}  // namespace
}  // namespace spherule::compute::cpu
