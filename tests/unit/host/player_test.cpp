#include "host/player.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "net/command_rules.h"
#include "recording_support.h"

namespace spherule::host {
namespace {

using namespace std::chrono_literals;

// Plays a film of 23 frames, one every 0.1 s. The tests set the clock.
class PlayerTest : public testing::Test {
  protected:
    static constexpr double end = 2.2;  // s

    PlayerTest() { recording::film(path_, 23); }

    void open(bool again = false) {
        auto recording = recording::Recording::open(path_);
        if (!recording) throw std::runtime_error(recording.error().text());
        player_.emplace(std::move(*recording), "film.sph", again, now_);
        moved_ = player_->advance(now_);
    }

    // Advances the clock; returns the time (s) of the frame that is then shown.
    double after(std::chrono::milliseconds time) {
        now_ += time;
        moved_ = player_->advance(now_);
        EXPECT_TRUE(!moved_.shown || player_->recording().shows());
        return player_->recording().time();
    }

    Result<sim::Applied> give(const v1::Command& command) { return player_->apply(command, now_); }
    bool seek(double time) {
        v1::Command command;
        command.mutable_seek()->set_time(time);
        return give(command).has_value();
    }
    template <class Make>
    bool tell(Make make) {
        v1::Command command;
        (command.*make)();
        return give(command).has_value();
    }
    bool step(std::uint32_t count) {
        v1::Command command;
        command.mutable_step()->set_count(count);
        return give(command).has_value();
    }
    bool setSpeed(double speed) {
        v1::Command command;
        command.mutable_set()->set_speed(speed);
        return give(command).has_value();
    }
    // Changes a bit of the first record of a kind after `time` (s); returns the record's offset.
    std::uint64_t damage(double time, recording::Kind kind = recording::Kind::Delta) {
        const auto file = recording::RecordFile::open(path_);
        std::uint64_t offset = recording::fileHeadBytes;
        for (;;) {
            const auto record = file->readHead(offset);
            if (!record) throw std::runtime_error(record.error().text());
            if (record->kind == kind && record->time > time) break;
            offset = record->end;
        }
        std::string content = recording::contentOf(path_);
        content[offset + 40] = static_cast<char>(content[offset + 40] ^ 4);
        recording::writeFile(path_, content);
        return offset;
    }
    // Advances the clock to the time when the player is due, as PlaybackProducer does. Returns false when it is not
    // due.
    bool comeWhenDue() {
        const auto due = player_->due();
        if (!due) return false;
        now_ = std::max(now_, *due);
        moved_ = player_->advance(now_);
        return true;
    }

    recording::TemporaryFolder folder_;
    std::string path_ = folder_ / "film.sph";
    Player::Clock::time_point now_ = Player::Clock::now();
    std::optional<Player> player_;
    Player::Moved moved_;
};

TEST_F(PlayerTest, ShowsTheFrameDueAtTheClockTime) {
    open();
    EXPECT_TRUE(moved_.shown);
    EXPECT_NEAR(after(0ms), 0, 1e-9);
    EXPECT_FALSE(moved_.shown);
    EXPECT_NEAR(after(90ms), 0, 1e-9);
    EXPECT_NEAR(after(20ms), 0.1, 1e-9);
    EXPECT_TRUE(moved_.shown);
    EXPECT_NEAR(after(1000ms), 1.1, 1e-9);
    ASSERT_TRUE(setSpeed(0.5));
    EXPECT_NEAR(after(400ms), 1.3, 1e-9);
    ASSERT_TRUE(setSpeed(8));
    EXPECT_NEAR(after(100ms), 2.1, 1e-9);
}

TEST_F(PlayerTest, IsDueOncePerFrame) {
    open();
    int frames = 1;
    int calls = 0;
    for (; comeWhenDue(); ++calls) frames += moved_.shown ? 1 : 0;
    EXPECT_EQ(frames, 23);
    EXPECT_LE(calls, 24);  // one more for the end
    EXPECT_TRUE(player_->paused());
    EXPECT_TRUE(player_->settings().paused());
}

TEST_F(PlayerTest, PausesAndResumesAtTheSameTime) {
    open();
    after(550ms);
    ASSERT_TRUE(tell(&v1::Command::mutable_pause));
    EXPECT_FALSE(player_->due());
    EXPECT_NEAR(after(5000ms), 0.5, 1e-9);
    ASSERT_TRUE(tell(&v1::Command::mutable_resume));
    EXPECT_NEAR(after(40ms), 0.5, 1e-9);
    EXPECT_NEAR(after(20ms), 0.6, 1e-9);
}

TEST_F(PlayerTest, SeeksWhilePaused) {
    open();
    ASSERT_TRUE(tell(&v1::Command::mutable_pause));
    for (const double time : {1.55, 0.3, 2.0, -7.0, 99.0, 1.0}) {
        ASSERT_TRUE(seek(time));
        EXPECT_LE(*player_->due(), now_);
        const double wanted = std::floor(std::clamp(time, 0.0, end) / 0.1 + 1e-6) * 0.1;
        EXPECT_NEAR(after(1ms), wanted, 1e-9);
        EXPECT_TRUE(moved_.shown);
    }
    EXPECT_FALSE(seek(std::numeric_limits<double>::quiet_NaN()));
    ASSERT_TRUE(seek(1.5));
    ASSERT_TRUE(tell(&v1::Command::mutable_resume));
    after(0ms);
    EXPECT_NEAR(after(110ms), 1.6, 1e-9);
}

TEST_F(PlayerTest, StepsAndPauses) {
    open();
    ASSERT_TRUE(step(1));
    EXPECT_NEAR(after(0ms), 0.1, 1e-9);
    EXPECT_FALSE(player_->due());
    EXPECT_NEAR(after(5000ms), 0.1, 1e-9);
    ASSERT_TRUE(step(3));
    while (comeWhenDue()) EXPECT_TRUE(moved_.shown);
    EXPECT_NEAR(after(0ms), 0.4, 1e-9);
    EXPECT_FALSE(step(0));
    ASSERT_TRUE(step(1000));
    for (int k = 0; k < 100 && comeWhenDue();) ++k;
    EXPECT_NEAR(after(0ms), end, 1e-9);
    EXPECT_FALSE(player_->due());
}

TEST_F(PlayerTest, ResumeAtTheEndAndResetRestartPlayback) {
    open();
    EXPECT_NEAR(after(9000ms), end, 1e-9);
    after(0ms);
    EXPECT_TRUE(player_->paused());
    ASSERT_TRUE(tell(&v1::Command::mutable_resume));
    EXPECT_NEAR(after(10ms), 0, 1e-9);
    EXPECT_FALSE(player_->paused());
    after(1000ms);
    ASSERT_TRUE(tell(&v1::Command::mutable_reset));
    EXPECT_NEAR(after(10ms), 0, 1e-9);
    EXPECT_NEAR(after(150ms), 0.1, 1e-9);
}

TEST_F(PlayerTest, LoopsOnRequest) {
    open(true);
    int rounds = 0;
    double last = 0;
    for (int k = 0; k < 100; ++k) {
        ASSERT_TRUE(comeWhenDue());
        if (player_->recording().time() < last) ++rounds;
        last = player_->recording().time();
    }
    EXPECT_GE(rounds, 3);
    EXPECT_FALSE(player_->paused());
}

TEST_F(PlayerTest, RefusesCommandsThatChangeTheRecording) {
    open();
    EXPECT_FALSE(tell(&v1::Command::mutable_query));
    EXPECT_FALSE(tell(&v1::Command::mutable_spawn));
    EXPECT_FALSE(tell(&v1::Command::mutable_start_recording));
    v1::Command both;
    both.mutable_set()->set_speed(3);
    both.mutable_set()->set_friction(0.1);
    EXPECT_FALSE(give(both));
    EXPECT_FALSE(setSpeed(0));
    EXPECT_EQ(player_->speed(), 1);
}

TEST_F(PlayerTest, AcceptsExactlyTheCommandsAllowedDuringPlayback) {
    open();
    int carriedOut = 0;
    for (const auto* const kind : net::commandFields()) {
        v1::Command command;
        command.GetReflection()->MutableMessage(&command, kind);
        const auto applied = give(command);
        const bool unknown =
            !applied && applied.error().message.find("nothing in it can be changed") != std::string::npos;
        EXPECT_EQ(!unknown, net::rulesOf(command).while_playing()) << kind->name();
        if (applied) ++carriedOut;
    }
    EXPECT_GE(carriedOut, 5);  // a step without a count is refused
}

TEST_F(PlayerTest, ReportsAndSkipsDamage) {
    const std::uint64_t offset = damage(0.65);  // the next keyframe is at 1.0 s
    open();
    EXPECT_NEAR(after(650ms), 0.6, 1e-9);
    EXPECT_NEAR(after(100ms), 1.0, 1e-9);
    ASSERT_EQ(moved_.damage.size(), 1U);
    EXPECT_NE(moved_.damage[0].find("byte " + std::to_string(offset)), std::string::npos);
    EXPECT_TRUE(moved_.shown);
    EXPECT_NEAR(after(110ms), 1.1, 1e-9);
    ASSERT_TRUE(seek(0.8));
    EXPECT_NEAR(after(0ms), 1.0, 1e-9);
    EXPECT_EQ(moved_.damage.size(), 1U);
}

TEST_F(PlayerTest, StopsOrLoopsAtADamagedEnd) {
    damage(2.05);  // the last keyframe is at 2.0 s
    open(true);
    EXPECT_NEAR(after(1300ms), 1.3, 1e-9);
    after(900ms);
    EXPECT_EQ(moved_.damage.size(), 1U);
    EXPECT_NEAR(player_->recording().time(), 2.0, 1e-9);
    EXPECT_TRUE(moved_.shown);
    // In a loop, the damage is reported once per round.
    std::size_t told = 0;
    for (int k = 0; k < 40; ++k) {
        ASSERT_TRUE(comeWhenDue());
        told += moved_.damage.size();
    }
    EXPECT_GE(told, 1U);
    EXPECT_LE(told, 3U);
    ASSERT_TRUE(tell(&v1::Command::mutable_pause));
    ASSERT_TRUE(seek(2.15));
    after(0ms);
    EXPECT_EQ(moved_.damage.size(), 1U);
    for (int k = 0; k < 5; ++k) {
        after(100ms);
        EXPECT_TRUE(moved_.damage.empty());
    }
    EXPECT_FALSE(player_->due());
    ASSERT_TRUE(step(1000));
    told = 0;
    for (int k = 0; k < 100 && comeWhenDue(); ++k) told += moved_.damage.size();
    EXPECT_LE(told, 1U);
    EXPECT_FALSE(player_->due());
    ASSERT_TRUE(tell(&v1::Command::mutable_resume));
    EXPECT_NEAR(after(10ms), 0, 1e-9);
}

TEST_F(PlayerTest, StopsWhenNoIntactKeyframeFollowsDamage) {
    damage(1.55);
    damage(1.95, recording::Kind::Resync);
    open();
    EXPECT_NEAR(after(1300ms), 1.3, 1e-9);
    after(400ms);
    EXPECT_EQ(moved_.damage.size(), 1U);
    after(1000ms);
    EXPECT_TRUE(player_->paused());
    ASSERT_TRUE(tell(&v1::Command::mutable_resume));
    EXPECT_NEAR(after(10ms), 0, 1e-9);
}

TEST_F(PlayerTest, WaitsForAFrameAfterALongInterval) {
    // The same frames with intervals of 10,000 s.
    const std::string film = recording::contentOf(path_);
    std::string content = film.substr(0, recording::fileHeadBytes);
    for (const std::string& record : recording::recordsOf(film)) {
        const auto kind = recording::kindOf(record);
        if (kind == recording::Kind::Index) break;
        recording::addRecord(content, kind, 1e5 * recording::timeOf(record), recording::payloadOf(record));
    }
    recording::writeFile(path_, content);
    open();
    EXPECT_NEAR(after(5000s), 0, 1e-9);
    ASSERT_TRUE(player_->due());
    EXPECT_GT(*player_->due(), now_);
    EXPECT_NEAR(after(5001s), 1e4, 1e-9);
}

TEST_F(PlayerTest, SeekAndResetEndSteps) {
    open();
    ASSERT_TRUE(step(1000));
    after(0ms);
    ASSERT_TRUE(tell(&v1::Command::mutable_reset));
    after(0ms);
    EXPECT_FALSE(player_->due());
    ASSERT_TRUE(step(1000));
    ASSERT_TRUE(seek(1));
    ASSERT_TRUE(seek(1.5));
    EXPECT_NEAR(after(0ms), 1.5, 1e-9);
    EXPECT_FALSE(player_->due());
    // Steps and resume that follow a seek start from its target.
    ASSERT_TRUE(seek(0.5));
    ASSERT_TRUE(step(2));
    while (comeWhenDue()) continue;
    EXPECT_NEAR(after(0ms), 0.7, 1e-9);
    ASSERT_TRUE(seek(2.2));
    after(0ms);
    ASSERT_TRUE(seek(1));
    ASSERT_TRUE(tell(&v1::Command::mutable_resume));
    EXPECT_NEAR(after(0ms), 1, 1e-9);
    EXPECT_NEAR(after(110ms), 1.1, 1e-9);
}

TEST_F(PlayerTest, ConvertsFileNamesToUtf8) {
    auto recording = recording::Recording::open(path_);
    const Player player(std::move(*recording), "bed-\xff.sph", false, now_);
    EXPECT_EQ(player.timeline().file(), "bed-\xEF\xBF\xBD.sph");
}

TEST_F(PlayerTest, ShowsOneOfSeveralFramesWithEqualTimes) {
    const recording::TemporaryFolder folder;
    recording::filmWithRepeatedTimes(folder / "film.sph");
    Player::Clock::time_point now{};
    Player player(recording::Recording::open(folder / "film.sph").value(), "film.sph", false, now);
    player.advance(now);
    v1::Command step;
    step.mutable_step()->set_count(1);
    for (int k = 1; k < 5; ++k) {
        ASSERT_TRUE(player.apply(step, now));
        EXPECT_TRUE(player.advance(now += std::chrono::seconds(1)).shown);
        EXPECT_NEAR(player.recording().time(), 0.2 * k, 1e-9);
    }
}

}  // namespace
}  // namespace spherule::host
