// Recordings of each version of the format that is read.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "recording/record.h"
#include "recording_support.h"

namespace spherule::recording {
namespace {

std::string pathOf(std::uint32_t version) {
    return SPHERULE_GOLDEN "/recording/version-" + std::to_string(version) + ".sph";
}

class Versions : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Versions, ArePlayedFromAnyFrame) {
    const auto file = RecordFile::open(pathOf(GetParam()));
    ASSERT_TRUE(file) << file.error().text();
    EXPECT_EQ(file->head().version, GetParam());
    EXPECT_EQ(file->head().id != 0, GetParam() > 1);
    auto recording = Recording::open(pathOf(GetParam()));
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->damage(), "");
    EXPECT_EQ(recording->facts().name(), "two-spheres");
    std::string end;
    const auto whole = play(*recording, &end);
    EXPECT_EQ(end, "");
    ASSERT_EQ(whole.size(), 11U);
    EXPECT_DOUBLE_EQ(recording->time(), 2.5);
    for (const std::size_t n : {10U, 2U, 9U}) {
        ASSERT_TRUE(recording->seek(0.25 * static_cast<double>(n) + 1e-6));
        const auto positions = recording->now().positions;
        EXPECT_EQ(distance({positions.begin(), positions.end()}, whole[n]), 0) << n;
    }
}

INSTANTIATE_TEST_SUITE_P(Recordings, Versions, testing::Values(1U, 2U));

TEST(Version2, HasTheSameRecordsWithOtherChecksums) {
    const std::string first = contentOf(pathOf(1));
    const std::string second = contentOf(pathOf(2));
    const auto before = recordsOf(first);
    const auto after = recordsOf(second);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
        EXPECT_EQ(before[k].substr(0, recordHeadBytes), after[k].substr(0, recordHeadBytes)) << k;
        EXPECT_EQ(payloadOf(before[k]), payloadOf(after[k])) << k;
        EXPECT_NE(before[k], after[k]) << k;
    }
}

TEST(Version1, HasNoLogs) {
    const TemporaryFolder folder;
    for (const std::uint32_t version : {1U, 2U}) {
        std::string file = FileHead{.version = version, .id = 0}.bytes();
        addRecord(file, Kind::Log, 0, "the bytes of a log");
        writeFile(folder / "log.sph", file);
        const auto opened = RecordFile::open(folder / "log.sph");
        ASSERT_TRUE(opened) << opened.error().text();
        EXPECT_EQ(opened->read(fileHeadBytes).has_value(), version == 2);
    }
}

// Players skip a log, wherever it is.
TEST(Version2, PlaysTheSameWithALog) {
    const TemporaryFolder folder;
    const std::string plain = contentOf(pathOf(2));
    std::string with = plain.substr(0, fileHeadBytes);
    addRecord(with, Kind::Log, 0, "before all others");
    for (const std::string& record : recordsOf(plain)) {
        if (kindOf(record) == Kind::Index) break;
        addRecord(with, kindOf(record), timeOf(record), payloadOf(record));
        addRecord(with, Kind::Log, timeOf(record), "more");
    }
    writeFile(folder / "log.sph", with);
    auto one = Recording::open(pathOf(2));
    auto other = Recording::open(folder / "log.sph");
    ASSERT_TRUE(one && other);
    EXPECT_EQ(other->damage(), "it was not finished");
    EXPECT_EQ(play(*one), play(*other));
}

}  // namespace
}  // namespace spherule::recording
