// Recordings that were cut, changed, and put together from records of the same and of another recording.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording_support.h"

namespace spherule::recording {
namespace {

constexpr double bound = Film::quantum / 2 + 1e-6;  // m
constexpr std::uint32_t frames = 12;

// A finished recording, in parts.
struct Parts {
    explicit Parts(std::string file)
        : content(std::move(file)),
          head(content.substr(0, fileHeadBytes)),
          records(recordsOf(content)),
          trailer(content.substr(content.size() - trailerBytes)) {}

    std::string content;
    std::string head;
    std::vector<std::string> records;  // with the index
    std::string trailer;
};

std::string joined(const Parts& parts, const std::vector<std::string>& records) {
    std::string file = parts.head;
    for (const std::string& record : records) file += record;
    return file + parts.trailer;
}

// Writes a film with an event after each frame. Nothing but its checksum tells the place of an event.
Film filmWithEvents(const std::string& path, std::uint32_t fileId) {
    Film made = film(path, frames, true, fileId);
    auto writer = Writer::create(path, true, fileId);
    const auto add = [&writer](Kind kind, double time, std::string_view payload) {
        if (!writer->add(kind, time, payload)) throw std::runtime_error("a record cannot be written");
    };
    for (const std::string& record : made.records) {
        add(kindOf(record), timeOf(record), payloadOf(record));
        v1::ServerMessage message;
        message.mutable_event()->set_text("at " + std::to_string(timeOf(record)));
        if (isFrame(kindOf(record))) add(Kind::Other, timeOf(record), message.SerializeAsString());
    }
    if (!writer->finish()) throw std::runtime_error("the film cannot be finished");
    return made;
}

class Spliced : public testing::Test {
  protected:
    [[nodiscard]] std::size_t below(std::size_t end) { return random_() % end; }

    // Returns the recording with one of the kinds of damage.
    std::string damaged(std::size_t kind) {
        std::string file = own_.content;
        std::vector<std::string> records = own_.records;
        const std::size_t at = below(records.size());
        const auto place = records.begin() + static_cast<std::ptrdiff_t>(at);
        switch (kind) {
            case 0:  // cut
                return file.substr(0, below(file.size()));
            case 1:  // bits
                for (std::size_t bits = 1 + below(3); bits > 0; --bits) {
                    char& byte = file[below(file.size())];
                    byte = static_cast<char>(byte ^ (1U << below(8)));
                }
                return file;
            case 2:  // exchanged
                std::swap(records[at], records[below(records.size())]);
                break;
            case 3: {  // repeated
                const std::string again = records[at];
                records.insert(records.begin() + static_cast<std::ptrdiff_t>(below(records.size() + 1)), again);
                break;
            }
            case 4:  // left out
                records.erase(place, place + static_cast<std::ptrdiff_t>(1 + below(records.size() - at)));
                break;
            case 5:  // the record at this place of another recording
                *place = other_.records[at];
                break;
            case 6:  // any record of another recording
                *place = other_.records[below(other_.records.size())];
                break;
            default:  // the end of another recording
                records.resize(at);
                records.insert(records.end(), other_.records.begin() + static_cast<std::ptrdiff_t>(at),
                               other_.records.end());
                break;
        }
        return joined(own_, records);
    }

    // Plays to the end, also behind damage. Returns true if nothing was wrong.
    bool plays(const std::string& content, const std::string& what) {
        writeFile(path_, content);
        auto recording = Recording::open(path_);
        if (!recording) {
            EXPECT_EQ(recording.error().text().find(path_), 0U) << what;
            return false;
        }
        bool right = recording->damage().empty();
        for (;;) {
            const auto more = recording->next();
            right = right && more;
            if (more ? !*more : !recording->recover(recording->time())) return right;
            expectRecorded(*recording, what);
        }
    }
    // The frame is the one that was recorded at its time.
    void expectRecorded(Recording& recording, const std::string& what) const {
        const auto n = static_cast<std::size_t>(std::llround(recording.time() / Film::interval));
        ASSERT_LT(n, film_.frames.size()) << what;
        const auto positions = recording.now().positions;
        EXPECT_LE(distance({positions.begin(), positions.end()}, film_.frames[n]), bound) << what << ", frame " << n;
    }

    TemporaryFolder folder_;
    std::string path_ = folder_ / "spliced.sph";
    Film film_ = filmWithEvents(folder_ / "own.sph", Film::fileId);
    Parts own_{contentOf(folder_ / "own.sph")};
    Parts other_ = [this] {
        filmWithEvents(folder_ / "other.sph", Film::fileId + 1);
        return Parts(contentOf(folder_ / "other.sph"));
    }();
    std::mt19937 random_{1};
};

TEST_F(Spliced, IsNeverTakenForUndamaged) {
    constexpr int most = 1000;
    constexpr std::size_t kinds = 8;
    ASSERT_EQ(own_.records.size(), other_.records.size());
    ASSERT_TRUE(plays(own_.content, "as it was"));
    for (int tried = 0; tried < most;) {
        const std::size_t kind = static_cast<std::size_t>(tried) % kinds;
        const std::string content = damaged(kind);
        if (content == own_.content) continue;
        const std::string what = "number " + std::to_string(tried) + " of kind " + std::to_string(kind);
        EXPECT_FALSE(plays(content, what)) << what;
        ++tried;
    }
}

// Each record takes its place in the other recording, where all records behind it stay where they are.
TEST_F(Spliced, RecordsOfTheSameLengthAndPlaceAreFound) {
    int tried = 0;
    for (std::size_t at = 0; at < own_.records.size(); ++at) {
        std::vector<std::string> records = own_.records;
        records[at] = other_.records[at];
        if (records[at].size() != own_.records[at].size()) continue;
        EXPECT_FALSE(plays(joined(own_, records), "record " + std::to_string(at)));
        ++tried;
    }
    EXPECT_GE(tried, 4);
}

TEST_F(Spliced, IdsFollowFromTheContent) {
    EXPECT_EQ(fileIdOf("a scene"), fileIdOf("a scene"));
    EXPECT_NE(fileIdOf("a scene"), fileIdOf("another scene"));
    EXPECT_NE(randomFileId(), randomFileId()) << "by chance in one of 2^32 runs";
}

}  // namespace
}  // namespace spherule::recording
