#include "app/tape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <thread>

#include "codec_support.h"
#include "recording_support.h"

namespace spherule::app {
namespace {

using namespace std::chrono_literals;
using Kind = codec::EncodedFrame::Kind;
constexpr std::uint32_t spheres = 70;
constexpr codec::Rendition rendition{v1::FINE, 30};

// A tape, and a chain of frames for it.
class Taping : public testing::Test {
  protected:
    Taping() { options_.folder = folder_ / "made"; }

    void open() {
        v1::Welcome source;
        source.set_server("spherule test");
        tape_ = std::make_unique<Tape>(options_, source);
        retain(recording::sceneMessage(1, spheres));
    }
    void retain(v1::ServerMessage message) { tape_->retain(codec::share(std::move(message))); }
    void order(std::uint32_t epoch = 1) { tape_->order(codec::share(recording::orderMessage(epoch, spheres))); }

    codec::EncodedFrame encoded(Kind kind, double time, std::uint32_t epoch = 1) {
        codec::Positions positions(spheres);
        for (std::uint32_t id = 0; id < spheres; ++id)
            positions[id] = {9 * std::sin(id + 37 * time), 9 * std::sin(7 * id - 53 * time), 0.1 * time, 0.5};
        const auto bytes = kind == Kind::Delta    ? encoder_.next(positions)
                           : kind == Kind::Resync ? encoder_.join()
                                                  : encoder_.begin(positions);
        if (kind != Kind::Resync) ++number_;
        v1::ServerMessage message;
        v1::Frame& frame = *message.mutable_frame();
        frame.set_epoch(epoch);
        frame.set_order(1);
        frame.set_sim_time(time);
        frame.set_quantum(0.125);
        frame.set_count(spheres);
        frame.set_spb(bytes.data(), bytes.size());
        return {rendition, kind, number_, codec::share(std::move(message))};
    }
    // Returns the state when all records are on the disk.
    v1::Recording ended() {
        v1::Recording state;
        for (int k = 0; k < 1000; ++k) {
            if (const auto news = tape_->news(Tape::Clock::now())) state = *news;
            if (k > 0 && !state.active()) break;
            std::this_thread::sleep_for(5ms);
        }
        return state;
    }
    [[nodiscard]] std::vector<codec::Subscription> subscriptions() const {
        std::vector<codec::Subscription> subscriptions;
        tape_->subscribe(subscriptions, Tape::Clock::now());
        return subscriptions;
    }

    recording::TemporaryFolder folder_;
    TapeOptions options_;
    std::unique_ptr<Tape> tape_;
    codec::Encoder encoder_{"cpu", spheres, 0.125};
    std::uint32_t number_ = 0;
};

TEST_F(Taping, WritesWhatAViewerIsSentFromAKeyframeOn) {
    open();
    EXPECT_TRUE(subscriptions().empty());
    order();
    ASSERT_TRUE(tape_->start());
    ASSERT_EQ(subscriptions().size(), 1U);
    EXPECT_TRUE(subscriptions()[0].newcomer);
    tape_->frame(encoded(Kind::Keyframe, 4.0));
    EXPECT_FALSE(subscriptions()[0].newcomer || subscriptions()[0].lost);
    tape_->frame(encoded(Kind::Delta, 4.1));
    tape_->frame(encoded(Kind::Resync, 4.1));
    tape_->frame(encoded(Kind::Delta, 4.2));
    ASSERT_TRUE(tape_->stop());
    const v1::Recording state = ended();
    EXPECT_EQ(state.failure(), "");
    EXPECT_NEAR(state.duration(), 0.2, 1e-9);
    auto recording = recording::Recording::open(state.file());
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->damage(), "");
    EXPECT_EQ(recording->frames(), 3U);
    EXPECT_EQ(recording->begin(), 4.0);
    EXPECT_EQ(recording::play(*recording).size(), 3U);
    EXPECT_TRUE(subscriptions().empty());
}

TEST_F(Taping, BeginsWithTheNextKeyframeOfAChainThatOthersWatch) {
    open();
    order();
    tape_->frame(encoded(Kind::Keyframe, 0));
    ASSERT_TRUE(tape_->start());
    tape_->frame(encoded(Kind::Delta, 0.1));
    EXPECT_TRUE(subscriptions()[0].newcomer);
    tape_->frame(encoded(Kind::Resync, 0.1));
    tape_->frame(encoded(Kind::Delta, 0.2));
    ASSERT_TRUE(tape_->stop());
    auto recording = recording::Recording::open(ended().file());
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->begin(), 0.1);
    EXPECT_EQ(recording::play(*recording).size(), 2U);
}

TEST_F(Taping, ItsTimeGoesOnWhenThatOfTheSimulationGoesBack) {
    open();
    order();
    ASSERT_TRUE(tape_->start());
    tape_->frame(encoded(Kind::Keyframe, 10));
    tape_->frame(encoded(Kind::Delta, 12));
    tape_->frame(encoded(Kind::Delta, 0));
    tape_->frame(encoded(Kind::Delta, 1));
    retain(recording::sceneMessage(2, spheres));
    order(2);
    tape_->frame(encoded(Kind::Keyframe, 0.5, 2));
    tape_->frame(encoded(Kind::Delta, 0.75, 2));
    ASSERT_TRUE(tape_->stop());
    auto recording = recording::Recording::open(ended().file());
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->frames(), 6U);
    EXPECT_NEAR(recording->end(), 13.25, 1e-9);
    EXPECT_EQ(recording::play(*recording).size(), 6U);
    EXPECT_EQ(recording->facts().epoch(), 2U);
}

TEST_F(Taping, WantsAKeyframeNowAndThenWhileSomethingMoves) {
    open();
    order();
    ASSERT_TRUE(tape_->start());
    tape_->frame(encoded(Kind::Keyframe, 0));
    std::vector<codec::Subscription> later;
    tape_->subscribe(later, Tape::Clock::now() + 1h);
    EXPECT_FALSE(later[0].lost);
    tape_->frame(encoded(Kind::Delta, 1));
    later.clear();
    tape_->subscribe(later, Tape::Clock::now() + 1h);
    EXPECT_TRUE(later[0].lost);
    EXPECT_FALSE(subscriptions()[0].lost);
}

TEST_F(Taping, AsksForAKeyframeAfterAGap) {
    open();
    order();
    ASSERT_TRUE(tape_->start());
    tape_->frame(encoded(Kind::Keyframe, 0));
    encoded(Kind::Delta, 1);
    tape_->frame(encoded(Kind::Delta, 2));
    EXPECT_TRUE(subscriptions()[0].lost);
    tape_->frame(encoded(Kind::Delta, 3));
    tape_->frame(encoded(Kind::Resync, 3));
    tape_->frame(encoded(Kind::Delta, 4));
    ASSERT_TRUE(tape_->stop());
    auto recording = recording::Recording::open(ended().file());
    ASSERT_TRUE(recording);
    std::string end;
    EXPECT_EQ(recording::play(*recording, &end).size(), 3U);
    EXPECT_EQ(end, "");
}

TEST_F(Taping, OneRecordingAtATimeAndASecondHasANameOfItsOwn) {
    open();
    order();
    EXPECT_EQ(tape_->stop().error().message, "nothing is being recorded");
    ASSERT_TRUE(tape_->start());
    EXPECT_NE(tape_->start().error().message.find("is being recorded already"), std::string::npos);
    tape_->frame(encoded(Kind::Keyframe, 0));
    ASSERT_TRUE(tape_->stop());
    const std::string first = ended().file();
    EXPECT_EQ(first.find((folder_ / "made") + "/film-"), 0U);
    ASSERT_TRUE(tape_->start());
    EXPECT_NE(tape_->news(Tape::Clock::now())->file(), first);
}

TEST_F(Taping, ItsFolderHasALimit) {
    options_.folderBytes = 3'000'000;
    std::filesystem::create_directories(options_.folder);
    recording::writeFile(options_.folder + "/old.sph", std::string(1'900'000, ' '));
    open();
    order();
    ASSERT_TRUE(tape_->start());
    for (int k = 0; k < 10'000; ++k) tape_->frame(encoded(k == 0 ? Kind::Keyframe : Kind::Delta, k));
    const v1::Recording state = ended();
    EXPECT_EQ(state.failure(), "it has reached its limit of 1.1 MB");
    auto recording = recording::Recording::open(state.file());
    ASSERT_TRUE(recording);
    EXPECT_EQ(recording->damage(), "");
    EXPECT_LE(std::filesystem::file_size(state.file()), 1'100'000U);
    EXPECT_NE(tape_->start().error().message.find("delete some"), std::string::npos);
    options_.folder.clear();
    open();
    EXPECT_NE(tape_->start().error().message.find("--recordings FOLDER"), std::string::npos);
}

TEST_F(Taping, WhereNothingCanBeWrittenItDoesNotBegin) {
    options_.path = "/dev/full";
    options_.replace = true;
    open();
    EXPECT_EQ(tape_->startFromOptions().error().kind, ErrorKind::Refused);
}

TEST_F(Taping, ARecordingWithoutFramesIsAFailure) {
    open();
    order();
    ASSERT_TRUE(tape_->start());
    const auto state = tape_->finish();
    ASSERT_TRUE(state);
    EXPECT_FALSE(state->active());
    EXPECT_EQ(state->failure(), "nothing was recorded: no frame has come");
    EXPECT_TRUE(std::filesystem::is_empty(options_.folder));
}

TEST_F(Taping, AFolderThatIsDeletedIsAFailure) {
    open();
    order();
    ASSERT_TRUE(tape_->start());
    tape_->frame(encoded(Kind::Keyframe, 0));
    std::filesystem::remove_all(options_.folder);
    v1::Recording state;
    for (int k = 0; k < 2000 && (k == 0 || state.active()); ++k) {
        if (const auto news = tape_->news(Tape::Clock::now())) state = *news;
        std::this_thread::sleep_for(5ms);
    }
    EXPECT_FALSE(state.active());
    EXPECT_EQ(state.failure(), "was deleted while it was written, or its folder was; nothing of it is kept");
    EXPECT_TRUE(tape_->start());  // in a new folder
}

TEST_F(Taping, IsNotLargerForWhatOthersAskFor) {
    open();
    order();
    ASSERT_TRUE(tape_->start());
    tape_->frame(encoded(Kind::Keyframe, 0));
    tape_->frame(encoded(Kind::Delta, 0.1));
    for (int k = 0; k < 50; ++k) tape_->frame(encoded(Kind::Resync, 0.1));
    v1::ServerMessage figures;
    figures.mutable_diagnostics();
    tape_->say(codec::share(figures));
    const auto state = tape_->finish();
    ASSERT_TRUE(state);
    const auto file = recording::RecordFile::open(state->file());
    int records = 0;
    for (std::uint64_t offset = recording::fileHeadBytes;;) {
        const auto record = file->read(offset);
        if (!record) break;
        EXPECT_NE(record->kind, recording::Kind::Resync);
        ++records;
        offset = record->end;
    }
    EXPECT_EQ(records, 6);  // source, scene, order, two frames, index
}

TEST_F(Taping, RoundingDoesNotSetTimeBack) {
    open();
    order();
    ASSERT_TRUE(tape_->start());
    const auto after = [](int steps) {
        double time = 0;
        for (int k = 0; k < steps; ++k) time += 1.0 / 60;
        return time;
    };
    tape_->frame(encoded(Kind::Keyframe, 0));
    for (int last = 1; last < 60; ++last)
        for (int first = 0; first < last; ++first) {
            tape_->frame(encoded(Kind::Delta, after(last)));
            tape_->frame(encoded(Kind::Delta, after(first)));
        }
    EXPECT_EQ(tape_->finish()->failure(), "");
}

TEST_F(Taping, OfAPausedWorldTakesNothing) {
    open();
    order();
    ASSERT_TRUE(tape_->start());
    const auto paused = [&](Kind kind, double time, std::uint32_t epoch = 1) {
        codec::EncodedFrame made = encoded(kind, time, epoch);
        v1::ServerMessage message = made.message->content();
        message.mutable_frame()->mutable_status()->set_paused(true);
        made.message = codec::share(std::move(message));
        tape_->frame(made);
    };
    tape_->frame(encoded(Kind::Keyframe, 0));
    tape_->frame(encoded(Kind::Delta, 1));
    for (int k = 0; k < 5; ++k) paused(Kind::Delta, 1);
    EXPECT_FALSE(subscriptions()[0].lost) << "before the world goes on";
    paused(Kind::Resync, 1);
    tape_->frame(encoded(Kind::Delta, 1));  // resumed, but still at the same step
    tape_->frame(encoded(Kind::Delta, 2));
    EXPECT_TRUE(subscriptions()[0].lost);
    tape_->frame(encoded(Kind::Resync, 2));
    tape_->frame(encoded(Kind::Delta, 3));
    paused(Kind::Delta, 3);
    paused(Kind::Delta, 0);  // the world was reset
    retain(recording::sceneMessage(2, spheres));
    order(2);
    paused(Kind::Keyframe, 0, 2);  // other spheres were loaded
    paused(Kind::Delta, 0.5, 2);   // the world was stepped
    paused(Kind::Resync, 0.5, 2);
    tape_->frame(encoded(Kind::Delta, 0.75, 2));
    ASSERT_TRUE(tape_->stop());
    auto recording = recording::Recording::open(ended().file());
    ASSERT_TRUE(recording) << recording.error().text();
    std::vector<double> times;
    while (recording->next().value()) times.push_back(recording->time());
    EXPECT_EQ(times, (std::vector<double>{0, 1, 2, 3, 3.5, 3.75}));
}

TEST_F(Taping, AHostileSceneNameIsNoPath) {
    open();
    v1::ServerMessage scene = recording::sceneMessage(1, spheres);
    scene.mutable_scene()->set_name("../../up/away\n;" + std::string(500, 'x'));
    retain(scene);
    order();
    ASSERT_TRUE(tape_->start());
    const std::filesystem::path path = tape_->news(Tape::Clock::now())->file();
    EXPECT_EQ(path.parent_path().string(), folder_ / "made");
    EXPECT_EQ(path.filename().string().find("upawayxxx"), 0U);
    EXPECT_LT(path.filename().string().size(), 80U);
}

}  // namespace
}  // namespace spherule::app
