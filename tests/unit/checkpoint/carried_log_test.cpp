// Command logs in recordings.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "checkpoint/log_reader.h"
#include "recording/bytes.h"
#include "recording/format.h"
#include "recording/writer.h"
#include "support.h"
#include "temporary_folder.h"

namespace spherule::checkpoint {
namespace {

constexpr int entries = 40;

// A log with a state, `entries` hashes and an end.
std::string logBytes() {
    std::string log = headOf(FileKind::CommandLog);
    Position position = positionAfter(log);
    const auto append = [&](const std::string& bytes) -> Result<void> {
        log += bytes;
        return {};
    };
    EXPECT_TRUE(write(exampleWorld(), position, append));
    for (int k = 0; k <= entries; ++k) {
        v1::LogEntry entry;
        entry.set_step(static_cast<std::uint64_t>(k));
        if (k < entries)
            entry.set_hash(static_cast<std::uint64_t>(k) * 77);
        else
            entry.mutable_ended();
        log += recordBytes(Kind::Entry, entry.SerializeAsString(), position);
    }
    return log;
}

// Writes a recording whose other records come between pieces of the log.
void record(const std::string& path, std::string_view log, std::mt19937& random) {
    auto writer = recording::Writer::create(path, true, 7);
    ASSERT_TRUE(writer);
    double time = 0;
    while (!log.empty()) {
        const std::size_t bytes = std::min<std::size_t>(log.size(), std::uniform_int_distribution(1, 200)(random));
        ASSERT_TRUE(writer->addLog(log.substr(0, bytes)));
        log.remove_prefix(bytes);
        for (int k = std::uniform_int_distribution(0, 2)(random); k > 0; --k)
            ASSERT_TRUE(writer->add(recording::Kind::Keyframe, time += 0.1, "a frame"));
    }
    ASSERT_TRUE(writer->add(recording::Kind::Keyframe, time, "the last frame"));
    ASSERT_TRUE(writer->finish());
}

// Returns the number of entries before the end or an error. `error`: its text, or empty.
int entriesIn(const std::string& path, std::string& error) {
    error.clear();
    auto log = LogReader::open(path);
    const auto world = log ? log->world() : Result<SavedWorld>(tl::unexpected(log.error()));
    if (!world) {
        error = world.error().text();
        return 0;
    }
    EXPECT_TRUE(sameState(world->state, exampleWorld().state));
    for (int count = 0;; ++count) {
        const auto entry = log->next();
        if (!entry) error = entry.error().text();
        if (!entry || !*entry) return count;
        EXPECT_EQ((*entry)->step(), static_cast<std::uint64_t>(count));
        EXPECT_TRUE(count == entries ? (*entry)->has_ended()
                                     : (*entry)->hash() == static_cast<std::uint64_t>(count) * 77);
    }
}

class CarriedLog : public testing::Test {
  protected:
    support::TemporaryFolder folder_;
    std::string path_ = folder_ / "run.sph";
    std::mt19937 random_{11};
    std::string error_;
};

TEST_F(CarriedLog, IsReadAsALog) {
    const std::string log = logBytes();
    for (int round = 0; round < 20; ++round) {
        record(path_, log, random_);
        EXPECT_EQ(entriesIn(path_, error_), entries + 1);
        EXPECT_EQ(error_, "");
    }
}

TEST_F(CarriedLog, IsMissedInARecordingWithoutOne) {
    record(path_, "", random_);
    EXPECT_EQ(entriesIn(path_, error_), 0);
    EXPECT_EQ(error_, path_ + ": carries no command log: it was recorded without --record-log");
}

// A recording that is cut off has the entries before the cut, and no others.
TEST_F(CarriedLog, EndsWhereTheRecordingIsCutOff) {
    record(path_, logBytes(), random_);
    const std::string whole = contentOf(path_);
    int most = 0;
    for (std::size_t bytes = 0; bytes < whole.size(); bytes += 7) {
        writeFile(path_, whole.substr(0, bytes));
        const int count = entriesIn(path_, error_);
        EXPECT_GE(count, most) << bytes;
        most = std::max(most, count);
    }
    EXPECT_EQ(most, entries + 1);
}

// 1,000 changes of bits: what is read is right up to an error, or the change was outside the log.
TEST_F(CarriedLog, IsNeverWrongInADamagedRecording) {
    const std::string log = logBytes();
    record(path_, log, random_);
    const std::string whole = contentOf(path_);
    int errors = 0;
    for (int k = 0; k < 1000; ++k) {
        std::string damaged = whole;
        const auto byte = std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random_);
        damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << k % 8));
        writeFile(path_, damaged);
        const int count = entriesIn(path_, error_);  // expects equal content
        if (count <= entries) {
            EXPECT_NE(error_, "") << byte;
            ++errors;
        }
    }
    // So many bytes of the file are of the log. Heads of its records add to them.
    EXPECT_GT(errors, 0.9 * 1000 * static_cast<double>(log.size()) / static_cast<double>(whole.size()));
}

TEST_F(CarriedLog, IsDamagedIfPiecesAreExchanged) {
    record(path_, logBytes(), random_);
    const std::string whole = contentOf(path_);
    std::vector<std::pair<std::size_t, std::size_t>> pieces;  // begin and size of the records
    for (std::size_t at = recording::fileHeadBytes; at + recording::recordHeadBytes < whole.size();) {
        const std::size_t bytes =
            recording::recordHeadBytes + recording::numberAt<std::uint32_t>(whole, at) + recording::checksumBytes;
        if (recording::numberAt<std::uint32_t>(whole, at + 4) == static_cast<std::uint32_t>(recording::Kind::Log))
            pieces.emplace_back(at, bytes);
        at += bytes;
    }
    ASSERT_GT(pieces.size(), 10U);
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
        const auto [begin, size] = pieces[k];
        const auto [after, sizeAfter] = pieces[k + 1];
        std::string exchanged = whole;
        exchanged.replace(begin, after + sizeAfter - begin,
                          whole.substr(after, sizeAfter) + whole.substr(begin + size, after - begin - size) +
                              whole.substr(begin, size));
        writeFile(path_, exchanged);
        EXPECT_LE(entriesIn(path_, error_), entries);
        EXPECT_NE(error_, "") << k;
    }
}

}  // namespace
}  // namespace spherule::checkpoint
