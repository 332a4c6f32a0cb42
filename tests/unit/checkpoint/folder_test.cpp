// The folder of checkpoints.
#include <gtest/gtest.h>

#include <dlfcn.h>
#include <sys/statvfs.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "checkpoint/folder.h"
#include "support.h"
#include "synced_folders.h"
#include "temporary_folder.h"

namespace {

std::optional<std::uint64_t> roomOnDisk;  // bytes; nullopt: as it is

}  // namespace

// std::filesystem::space() calls it.
extern "C" int statvfs(const char* path, struct statvfs* about) noexcept {
    static const auto real =
        reinterpret_cast<int (*)(const char*, struct statvfs*)>(dlsym(RTLD_NEXT, "statvfs"));  // NOLINT
    const int result = real(path, about);
    if (result == 0 && roomOnDisk) about->f_bavail = *roomOnDisk / about->f_frsize;
    return result;
}

namespace spherule::checkpoint {
namespace {

namespace fs = std::filesystem;

class CheckpointFolder : public testing::Test {
  protected:
    // Returns the step of the newest checkpoint that can be read, and collects what was passed over.
    std::uint64_t newest(Folder& folder) {
        skipped_.clear();
        std::uint64_t step = 0;
        const auto path = folder.useNewest(
            [&](const SavedWorld& world) -> Result<void> {
                step = world.head.step();
                return {};
            },
            [&](const Error& error) { skipped_.push_back(error.text()); });
        return path.value() ? step : 0;
    }
    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(place_)) names.push_back(entry.path().filename());
        std::ranges::sort(names);
        return names;
    }

    support::TemporaryFolder temporary_;
    std::string place_ = temporary_ / "a/b";
    std::vector<std::string> skipped_;
};

TEST_F(CheckpointFolder, GivesTheNewestStateAndKeepsAFew) {
    {
        auto folder = Folder::open(place_, 2).value();
        EXPECT_EQ(newest(folder), 0U);
        for (const std::uint8_t seed : {1, 2, 3}) ASSERT_TRUE(folder.write(exampleWorld(seed)));
    }
    EXPECT_EQ(names(), (std::vector<std::string>{"checkpoint-00000002.sphc", "checkpoint-00000003.sphc", "lock"}));
    auto folder = Folder::open(place_, 2).value();
    EXPECT_EQ(newest(folder), 123U);
    ASSERT_TRUE(folder.write(exampleWorld(4)));
    EXPECT_EQ(names().front(), "checkpoint-00000003.sphc");
    EXPECT_TRUE(sameState(readCheckpoint(place_ + "/checkpoint-00000004.sphc").value().state, exampleWorld(4).state));
}

TEST_F(CheckpointFolder, IsOnTheDiskWhenItHasBeenMade) {
    auto& synced = support::syncedFolders();
    synced.clear();
    ASSERT_TRUE(Folder::open(place_, 1));
    const std::string made = fs::canonical(place_).parent_path().string();
    EXPECT_TRUE(synced.contains(made)) << "the name of the folder";
    EXPECT_TRUE(synced.contains(fs::path(made).parent_path().string())) << "the name of the one in which it is";
    synced.clear();
    ASSERT_TRUE(Folder::open(place_, 1));
    EXPECT_TRUE(synced.empty());
}

TEST_F(CheckpointFolder, PassesOverWhatIsDamagedAndNeverRemovesIt) {
    auto folder = Folder::open(place_, 1).value();
    const std::string first = folder.write(exampleWorld(1)).value().path;
    const std::string good = contentOf(first);
    const std::string second = folder.write(exampleWorld(2)).value().path;
    writeFile(first, good);
    const std::string content = contentOf(second);
    writeFile(second, content.substr(0, content.size() - 1));
    EXPECT_EQ(newest(folder), 121U);
    ASSERT_EQ(skipped_.size(), 1U);
    EXPECT_TRUE(skipped_[0].starts_with(second)) << skipped_[0];
    EXPECT_TRUE(skipped_[0].ends_with("is cut off")) << skipped_[0];
    ASSERT_TRUE(folder.write(exampleWorld(3)));
    EXPECT_FALSE(fs::exists(first));
    EXPECT_TRUE(fs::exists(second + ".bad")) << "somebody may want to look at it";
    EXPECT_EQ(newest(folder), 123U);
}

TEST_F(CheckpointFolder, ReturnsErrorsThatAreNotOfTheFile) {
    auto folder = Folder::open(place_, 2).value();
    const std::string path = folder.write(exampleWorld(1)).value().path;
    const auto used = folder.useNewest(
        [](const SavedWorld&) -> Result<void> { return fail(ErrorKind::Refused, "", "there is no memory"); },
        [](const Error& error) { ADD_FAILURE() << error.text(); });
    ASSERT_FALSE(used);
    EXPECT_EQ(used.error().text(), path + ": there is no memory");
    EXPECT_TRUE(fs::exists(path));
}

TEST_F(CheckpointFolder, LeavesAFileAloneThatCannotBeRead) {
    auto folder = Folder::open(place_, 2).value();
    ASSERT_TRUE(folder.write(exampleWorld(1)));
    const std::string loop = place_ + "/checkpoint-00000002.sphc";
    fs::create_symlink(loop, loop);
    const auto used = folder.useNewest([](const SavedWorld&) -> Result<void> { return {}; },
                                       [](const Error& error) { ADD_FAILURE() << error.text(); });
    ASSERT_FALSE(used);
    EXPECT_EQ(used.error().kind, ErrorKind::Refused);
    EXPECT_TRUE(used.error().text().starts_with(loop + ": cannot be read")) << used.error().text();
    EXPECT_TRUE(fs::is_symlink(loop));
}

TEST_F(CheckpointFolder, SetsFilesAsideUnderNamesThatAreFree) {
    auto folder = Folder::open(place_, 2).value();
    const std::string path = place_ + "/checkpoint-00000001.sphc";
    writeFile(path + ".bad", "of an earlier time");
    writeFile(path, "x");
    EXPECT_EQ(newest(folder), 0U);
    EXPECT_EQ(contentOf(path + ".bad"), "of an earlier time");
    EXPECT_EQ(contentOf(path + ".bad2"), "x");
}

TEST_F(CheckpointFolder, LeavesOtherFilesAlone) {
    fs::create_directories(place_);
    for (const char* const name : {"checkpoint-7.sphc", "checkpoint-18446744073709551615.sphc", "checkpoint-.sphc",
                                   "checkpoint-1000000000000.sphc"})
        writeFile(place_ + "/" + name, "x");
    auto folder = Folder::open(place_, 1).value();
    EXPECT_EQ(folder.count(), 0U);
    for (const std::uint8_t seed : {1, 2}) ASSERT_TRUE(folder.write(exampleWorld(seed)));
    EXPECT_EQ(names().size(), 6U);  // one checkpoint, the lock, and the others
    // A program that does not know the lock has made the next file.
    writeFile(place_ + "/checkpoint-00000003.sphc", "x");
    EXPECT_EQ(folder.write(exampleWorld(3)).value().path, place_ + "/checkpoint-00000004.sphc");
}

TEST_F(CheckpointFolder, IsUsedByOneProgramAtATime) {
    auto folder = Folder::open(place_, 2);
    ASSERT_TRUE(folder);
    const auto second = Folder::open(place_, 2);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, ErrorKind::Input);
    EXPECT_NE(second.error().message.find("is used by another program"), std::string::npos) << second.error().text();
}

TEST_F(CheckpointFolder, RemovesWhatWasInterrupted) {
    fs::create_directories(place_);
    for (const char* const name : {"checkpoint-00000007.sphc.part", "checkpoint-00000007.sphc.part2", "notes.part"})
        writeFile(place_ + "/" + name, "x");
    const auto folder = Folder::open(place_, 2);
    ASSERT_TRUE(folder);
    EXPECT_EQ(names(), (std::vector<std::string>{"lock", "notes.part"}));
}

// A full disk is like a device that takes nothing: the folder of such files cannot be made here, so the folder is gone.
TEST_F(CheckpointFolder, NamesAFolderThatIsGone) {
    auto folder = Folder::open(place_, 2).value();
    ASSERT_TRUE(folder.write(exampleWorld(1)));
    fs::remove_all(place_);
    const auto written = folder.write(exampleWorld(2));
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().text().find(place_), std::string::npos) << written.error().text();
    fs::create_directories(place_);
    EXPECT_TRUE(folder.write(exampleWorld(3)));
}

TEST_F(CheckpointFolder, DoesNotFillADiskThatIsNearlyFull) {
    auto folder = std::make_unique<Folder>(Folder::open(place_, 2).value());
    ASSERT_TRUE(folder->write(exampleWorld(1)));
    for (const bool again : {false, true}) {  // also the first one after a start
        if (again) {
            folder.reset();
            folder = std::make_unique<Folder>(Folder::open(place_, 2).value());
        }
        roomOnDisk = 1U << 20U;
        const auto written = folder->write(exampleWorld(2));
        roomOnDisk.reset();
        ASSERT_FALSE(written);
        EXPECT_EQ(written.error().kind, ErrorKind::Refused);
        EXPECT_EQ(names(), (std::vector<std::string>{"checkpoint-00000001.sphc", "lock"}));
    }
    roomOnDisk = 10U << 20U;
    EXPECT_TRUE(folder->write(exampleWorld(2)));
    roomOnDisk.reset();
}

TEST_F(CheckpointFolder, RefusesAFileAsAFolder) {
    const std::string file = temporary_.write("file", "x");
    const auto folder = Folder::open(file, 2);
    ASSERT_FALSE(folder);
    EXPECT_EQ(folder.error().where, file);
}

}  // namespace
}  // namespace spherule::checkpoint
