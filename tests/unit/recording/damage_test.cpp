// Truncated files, and files with changed bytes.
#include <gtest/gtest.h>

#include "recording_support.h"

namespace spherule::recording {
namespace {

constexpr double bound = Film::quantum / 2 + 1e-6;  // m

class Damage : public testing::Test {
  protected:
    // Number of complete frames in the first `bytes` of the file.
    [[nodiscard]] std::size_t wholeWithin(std::size_t bytes) const {
        std::size_t frames = 0;
        std::size_t end = fileHeadBytes;
        for (const std::string& record : film_.records) {
            end += record.size();
            if (end > bytes) break;
            if (isFrame(static_cast<Kind>(record[4]))) ++frames;
        }
        return frames;
    }

    TemporaryFolder folder_;
    std::string path_ = folder_ / "film.sph";
    Film film_ = film(path_, 8);
    std::string content_ = contentOf(path_);
};

TEST_F(Damage, TruncatedFilePlaysUpToTheCut) {
    const std::string cut = folder_ / "cut.sph";
    for (std::size_t bytes = 0; bytes < content_.size(); ++bytes) {
        writeFile(cut, content_.substr(0, bytes));
        auto recording = Recording::open(cut);
        const std::size_t whole = wholeWithin(bytes);
        if (whole == 0) {
            ASSERT_FALSE(recording) << bytes;
            continue;
        }
        ASSERT_TRUE(recording) << bytes << recording.error().text();
        EXPECT_NE(recording->damage(), "") << bytes;
        EXPECT_EQ(recording->frames(), whole) << bytes;
        std::string end;
        const auto frames = play(*recording, &end);
        ASSERT_EQ(frames.size(), whole) << bytes;
        EXPECT_EQ(end, "") << bytes;
        EXPECT_LE(distance(frames.back(), film_.frames[whole - 1]), bound) << bytes;
    }
}

TEST_F(Damage, ReportsATruncatedFile) {
    writeFile(path_, content_.substr(0, content_.size() - 1));
    EXPECT_EQ(Recording::open(path_)->damage(), "its end is damaged");
    std::size_t end = fileHeadBytes;
    for (const std::string& record : film_.records) end += record.size();
    writeFile(path_, content_.substr(0, end));
    EXPECT_EQ(Recording::open(path_)->damage(), "it was not finished");
    writeFile(path_, content_.substr(0, end - 1));
    EXPECT_EQ(Recording::open(path_)->damage(),
              "the record at byte " + std::to_string(end - film_.records.back().size()) + " is cut off");
}

// A damaged file plays up to the damage with correct positions, and reports the damage.
TEST_F(Damage, DetectsEveryFlippedByte) {
    const std::string flipped = folder_ / "flipped.sph";
    for (std::size_t byte = 0; byte < content_.size(); ++byte) {
        std::string content = content_;
        content[byte] = static_cast<char>(content[byte] ^ (1 << byte % 8));
        writeFile(flipped, content);
        auto recording = Recording::open(flipped);
        if (!recording) {
            EXPECT_EQ(recording.error().text().find(flipped), 0U);
            continue;
        }
        std::string end;
        const auto frames = play(*recording, &end);
        EXPECT_TRUE(!end.empty() || !recording->damage().empty()) << byte;
        for (std::size_t n = 0; n < frames.size(); ++n) ASSERT_LE(distance(frames[n], film_.frames[n]), bound) << byte;
    }
}

TEST_F(Damage, RecoversAtTheNextKeyframe) {
    std::size_t begin = fileHeadBytes;
    for (std::size_t record = 0; record < 4; ++record) begin += film_.records[record].size();
    content_[begin + 30] = static_cast<char>(content_[begin + 30] ^ 1);
    writeFile(path_, content_);
    auto recording = Recording::open(path_);
    ASSERT_TRUE(recording);
    std::string end;
    EXPECT_EQ(play(*recording, &end).size(), 2U);
    EXPECT_EQ(end, path_ + ": the record at byte " + std::to_string(begin) + " is damaged: its checksum differs");
    ASSERT_TRUE(recording->seek(0.5));
    EXPECT_EQ(play(*recording, &end).size(), 2U);
    EXPECT_EQ(end, "");
}

}  // namespace
}  // namespace spherule::recording
