// Damaged checkpoints and command logs: cut off, with changed bytes, and with parts of others.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "checkpoint/folder.h"
#include "checkpoint/log_reader.h"
#include "scene/random.h"
#include "support.h"
#include "temporary_folder.h"

namespace spherule::checkpoint {
namespace {

// Writes a log with a state, entries, and another state.
void writeLog(const std::string& path, std::uint8_t seed) {
    std::string content = headOf(FileKind::CommandLog);
    Position position = positionAfter(content);
    const WriteBytes bytes = [&](const std::string& more) -> Result<void> {
        content += more;
        return {};
    };
    const auto add = [&](const v1::LogEntry& entry) {
        content += recordBytes(Kind::Entry, entry.SerializeAsString(), position);
    };
    ASSERT_TRUE(write(exampleWorld(seed), position, bytes));
    v1::LogEntry entry;
    for (std::uint64_t step = 0; step < 40; ++step) {
        entry.set_step(step);
        if (step % 4 == 0)
            entry.mutable_carried()->mutable_command()->mutable_push()->set_sphere(step + seed);
        else
            entry.set_hash(step * 0x9e3779b97f4a7c15U + seed);
        add(entry);
    }
    entry.mutable_world();
    add(entry);
    ASSERT_TRUE(write(exampleWorld(seed + 1), position, bytes));
    entry.mutable_ended();
    add(entry);
    writeFile(path, content);
}

// Reads all of a log. Returns true if it is good to its end.
bool readsLog(const std::string& path) {
    auto log = LogReader::open(path);
    if (!log || !log->world()) return false;
    for (;;) {
        const auto entry = log->next();
        if (!entry || !*entry) return false;
        if ((*entry)->has_world() && !log->digestWorld()) return false;
        if ((*entry)->has_ended()) return true;
    }
}

struct File {
    FileKind kind{};
    std::function<void(const std::string& path, std::uint8_t seed)> write;
    std::function<bool(const std::string& path)> reads;
};

class Damaged : public testing::TestWithParam<const char*> {
  protected:
    Damaged() {
        if (std::string(GetParam()) == "log") {
            file_ = {FileKind::CommandLog, writeLog, readsLog};
            return;
        }
        file_ = {FileKind::Checkpoint,
                 [this](const std::string& path, std::uint8_t seed) {
                     auto folder = Folder::open(temporary_ / ("folder" + std::to_string(seed)), 1).value();
                     writeFile(path, contentOf(folder.write(exampleWorld(seed)).value().path));
                 },
                 [](const std::string& path) { return readCheckpoint(path).has_value(); }};
    }
    void SetUp() override {
        file_.write(path_, 1);
        content_ = contentOf(path_);
        ASSERT_TRUE(file_.reads(path_));
    }
    bool reads(const std::string& content) const {
        writeFile(path_, content);
        return file_.reads(path_);
    }

    support::TemporaryFolder temporary_;
    File file_;
    std::string path_ = temporary_ / "file";
    std::string content_;
};

INSTANTIATE_TEST_SUITE_P(Of, Damaged, testing::Values("checkpoint", "log"),
                         [](const auto& one) { return std::string(one.param); });

TEST_P(Damaged, IsNotTakenForGoodWhenItIsCutOff) {
    const std::size_t stride = 1 + content_.size() / 1000;
    for (std::size_t end = 0; end < content_.size(); end += stride) EXPECT_FALSE(reads(content_.substr(0, end))) << end;
    EXPECT_FALSE(reads(content_.substr(0, content_.size() - 1)));
}

TEST_P(Damaged, IsNotTakenForGoodWithChangedBits) {
    scene::Random random(7);
    const auto below = [&](std::size_t end) {
        return static_cast<std::size_t>(random.uniform(0, static_cast<double>(end)));
    };
    for (int round = 0; round < 1000; ++round) {
        std::string changed = content_;
        for (std::size_t flips = 1 + below(3); flips > 0; --flips) {
            const std::size_t place = round < 50 ? static_cast<std::size_t>(round) : below(changed.size());
            changed[place] = static_cast<char>(changed[place] ^ (1 << below(8)));
        }
        if (changed != content_) {
            EXPECT_FALSE(reads(changed)) << round;
        }
    }
}

// Whole records, which are good by themselves: exchanged, repeated, left out, or from another file of the same kind.
TEST_P(Damaged, IsNotTakenForGoodWithExchangedParts) {
    const std::vector<std::size_t> own = recordsIn(path_, file_.kind);
    const std::string other = temporary_ / "other";
    file_.write(other, 2);
    const std::string otherContent = contentOf(other);
    const std::vector<std::size_t> others = recordsIn(other, file_.kind);
    const auto record = [](const std::string& content, const std::vector<std::size_t>& places, std::size_t k) {
        return content.substr(places[k], places[k + 1] - places[k]);
    };
    const std::size_t records = own.size() - 1;
    ASSERT_EQ(others.size(), own.size());
    const auto with = [&](const std::function<std::string(std::size_t)>& recordAt) {
        std::string content = content_.substr(0, own.front());
        for (std::size_t k = 0; k < records; ++k) content += recordAt(k);
        return content;
    };
    EXPECT_TRUE(reads(with([&](std::size_t k) { return record(content_, own, k); })));
    for (std::size_t a = 0; a < records; ++a) {
        EXPECT_FALSE(reads(with([&](std::size_t k) { return record(content_, own, a == k ? (k + 1) % records : k); })));
        EXPECT_FALSE(reads(with([&](std::size_t k) { return k == a ? "" : record(content_, own, k); }))) << a;
        EXPECT_FALSE(reads(with([&](std::size_t k) {
            return a == k ? record(otherContent, others, k) : record(content_, own, k);
        }))) << a;
        if (a == 0) continue;
        EXPECT_FALSE(reads(with([&](std::size_t k) {
            return k == a ? record(content_, own, a - 1) : record(content_, own, k == a - 1 ? a : k);
        }))) << a;
        // The rest of another file.
        EXPECT_FALSE(reads(content_.substr(0, own[a]) + otherContent.substr(others[a]))) << a;
    }
}

TEST_P(Damaged, NamesTheVersionThatReadsAnotherFormat) {
    std::string changed = content_;
    changed[8] = 9;                   // the format
    changed.replace(12, 5, "7.8.9");  // the program
    writeFile(path_, changed);
    const auto opened = RecordReader::open(path_, file_.kind);
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().message.find("has format 9"), std::string::npos) << opened.error().text();
    EXPECT_NE(opened.error().message.find("Use spherule 7.8.9"), std::string::npos) << opened.error().text();
}

TEST_P(Damaged, IsNoFileOfAnotherKind) {
    const auto other = file_.kind == FileKind::Checkpoint ? FileKind::CommandLog : FileKind::Checkpoint;
    EXPECT_FALSE(RecordReader::open(path_, other));
}

}  // namespace
}  // namespace spherule::checkpoint
