#include "recording/live_recorder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <thread>

#include "codec_support.h"
#include "recording_support.h"

namespace spherule::recording {
namespace {

using namespace std::chrono_literals;
using FrameKind = codec::EncodedFrame::Kind;
constexpr std::uint32_t spheres = 70;
constexpr codec::Rendition rendition{v1::FINE, 30, true};

// A live recorder, and a chain of frames for it.
class LiveRecording : public testing::Test {
  protected:
    LiveRecording() { options_.folder = folder_ / "made"; }

    void open() {
        v1::Welcome source;
        source.set_server("spherule test");
        recorder_ = std::make_unique<LiveRecorder>(options_, source);
        retain(sceneMessage(1, spheres));
    }
    void retain(v1::ServerMessage message) { recorder_->retain(codec::share(std::move(message))); }
    void order(std::uint32_t epoch = 1) { recorder_->setOrder(codec::share(orderMessage(epoch, spheres))); }

    codec::EncodedFrame encoded(FrameKind kind, double time, std::uint32_t epoch = 1) {
        codec::Positions positions(spheres);
        for (std::uint32_t id = 0; id < spheres; ++id)
            positions[id] = {9 * std::sin(id + 37 * time), 9 * std::sin(7 * id - 53 * time), 0.1 * time, 0.5};
        const auto bytes = kind == FrameKind::Delta    ? encoder_.next(positions)
                           : kind == FrameKind::Resync ? encoder_.join()
                                                       : encoder_.begin(positions);
        if (kind != FrameKind::Resync) ++number_;
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
            if (const auto changed = recorder_->changedState(LiveRecorder::Clock::now())) state = *changed;
            if (k > 0 && !state.active()) break;
            std::this_thread::sleep_for(5ms);
        }
        return state;
    }
    [[nodiscard]] std::vector<codec::Subscription> subscriptions() const {
        std::vector<codec::Subscription> subscriptions;
        recorder_->subscribe(subscriptions, LiveRecorder::Clock::now());
        return subscriptions;
    }

    TemporaryFolder folder_;
    LiveOptions options_;
    std::unique_ptr<LiveRecorder> recorder_;
    codec::Encoder encoder_{"cpu", spheres, 0.125};
    std::uint32_t number_ = 0;
};

TEST_F(LiveRecording, WritesTheFramesSentToViewersFromAKeyframeOn) {
    open();
    EXPECT_TRUE(subscriptions().empty());
    order();
    ASSERT_TRUE(recorder_->start());
    ASSERT_EQ(subscriptions().size(), 1U);
    EXPECT_TRUE(subscriptions()[0].newcomer);
    recorder_->publish(encoded(FrameKind::Keyframe, 4.0));
    EXPECT_FALSE(subscriptions()[0].newcomer || subscriptions()[0].lost);
    recorder_->publish(encoded(FrameKind::Delta, 4.1));
    recorder_->publish(encoded(FrameKind::Resync, 4.1));
    recorder_->publish(encoded(FrameKind::Delta, 4.2));
    ASSERT_TRUE(recorder_->stop());
    const v1::Recording state = ended();
    EXPECT_EQ(state.failure(), "");
    EXPECT_NEAR(state.duration(), 0.2, 1e-9);
    auto recording = Recording::open(state.file());
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->damage(), "");
    EXPECT_EQ(recording->frames(), 3U);
    EXPECT_EQ(recording->begin(), 4.0);
    EXPECT_EQ(play(*recording).size(), 3U);
    EXPECT_TRUE(subscriptions().empty());
}

TEST_F(LiveRecording, StartsAtTheNextKeyframeOfARunningChain) {
    open();
    order();
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    ASSERT_TRUE(recorder_->start());
    recorder_->publish(encoded(FrameKind::Delta, 0.1));
    EXPECT_TRUE(subscriptions()[0].newcomer);
    recorder_->publish(encoded(FrameKind::Resync, 0.1));
    recorder_->publish(encoded(FrameKind::Delta, 0.2));
    ASSERT_TRUE(recorder_->stop());
    auto recording = Recording::open(ended().file());
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->begin(), 0.1);
    EXPECT_EQ(play(*recording).size(), 2U);
}

TEST_F(LiveRecording, TimeIncreasesWhenSimulationTimeGoesBack) {
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    recorder_->publish(encoded(FrameKind::Keyframe, 10));
    recorder_->publish(encoded(FrameKind::Delta, 12));
    recorder_->publish(encoded(FrameKind::Delta, 0));
    recorder_->publish(encoded(FrameKind::Delta, 1));
    retain(sceneMessage(2, spheres));
    order(2);
    recorder_->publish(encoded(FrameKind::Keyframe, 0.5, 2));
    recorder_->publish(encoded(FrameKind::Delta, 0.75, 2));
    ASSERT_TRUE(recorder_->stop());
    auto recording = Recording::open(ended().file());
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->frames(), 6U);
    EXPECT_NEAR(recording->end(), 13.25, 1e-9);
    EXPECT_EQ(play(*recording).size(), 6U);
    EXPECT_EQ(recording->facts().epoch(), 2U);
}

TEST_F(LiveRecording, RequestsKeyframesRegularlyWhileFramesArrive) {
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    std::vector<codec::Subscription> later;
    recorder_->subscribe(later, LiveRecorder::Clock::now() + 1h);
    EXPECT_FALSE(later[0].lost);
    recorder_->publish(encoded(FrameKind::Delta, 1));
    later.clear();
    recorder_->subscribe(later, LiveRecorder::Clock::now() + 1h);
    EXPECT_TRUE(later[0].lost);
    EXPECT_FALSE(subscriptions()[0].lost);
}

TEST_F(LiveRecording, RequestsAKeyframeAfterAGap) {
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    encoded(FrameKind::Delta, 1);
    recorder_->publish(encoded(FrameKind::Delta, 2));
    EXPECT_TRUE(subscriptions()[0].lost);
    recorder_->publish(encoded(FrameKind::Delta, 3));
    recorder_->publish(encoded(FrameKind::Resync, 3));
    recorder_->publish(encoded(FrameKind::Delta, 4));
    ASSERT_TRUE(recorder_->stop());
    auto recording = Recording::open(ended().file());
    ASSERT_TRUE(recording);
    std::string end;
    EXPECT_EQ(play(*recording, &end).size(), 3U);
    EXPECT_EQ(end, "");
}

TEST_F(LiveRecording, MakesOneRecordingAtATimeWithAUniqueName) {
    open();
    order();
    EXPECT_EQ(recorder_->stop().error().message, "nothing is being recorded");
    ASSERT_TRUE(recorder_->start());
    EXPECT_NE(recorder_->start().error().message.find("is being recorded already"), std::string::npos);
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    ASSERT_TRUE(recorder_->stop());
    const std::string first = ended().file();
    EXPECT_EQ(first.find((folder_ / "made") + "/film-"), 0U);
    ASSERT_TRUE(recorder_->start());
    EXPECT_NE(recorder_->changedState(LiveRecorder::Clock::now())->file(), first);
}

TEST_F(LiveRecording, EndsWhenItsLogHasBeenClosed) {
    options_.log = true;
    open();
    order();
    EXPECT_FALSE(recorder_->wantsLog());
    ASSERT_TRUE(recorder_->start());
    EXPECT_TRUE(recorder_->wantsLog());
    EXPECT_FALSE(recorder_->wantsLog());
    const auto log = recorder_->logSink();
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    ASSERT_TRUE(recorder_->stop());
    const auto refused = recorder_->start();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().cause, Cause::Busy);
    EXPECT_NE(refused.error().message.find("is still being written: wait until it is done"), std::string::npos);
    ASSERT_TRUE(log->write("the end of the log"));
    ASSERT_TRUE(log->close());
    ASSERT_TRUE(Recording::open(ended().file()));
    EXPECT_FALSE(recorder_->endedEmpty());
    ASSERT_TRUE(recorder_->start());
}

TEST_F(LiveRecording, LimitsTheSizeOfTheFolder) {
    options_.folderBytes = 3'000'000;
    std::filesystem::create_directories(options_.folder);
    writeFile(options_.folder + "/old.sph", std::string(1'900'000, ' '));
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    for (int k = 0; k < 10'000; ++k) recorder_->publish(encoded(k == 0 ? FrameKind::Keyframe : FrameKind::Delta, k));
    const v1::Recording state = ended();
    EXPECT_EQ(state.failure(), "it has reached its limit of 1.1 MB");
    auto recording = Recording::open(state.file());
    ASSERT_TRUE(recording);
    EXPECT_EQ(recording->damage(), "");
    EXPECT_LE(std::filesystem::file_size(state.file()), 1'100'000U);
    EXPECT_NE(recorder_->start().error().message.find("delete some"), std::string::npos);
    options_.folder.clear();
    open();
    EXPECT_NE(recorder_->start().error().message.find("--recordings FOLDER"), std::string::npos);
}

TEST_F(LiveRecording, IsRefusedIfTheFileIsNotWritable) {
    options_.path = "/dev/full";
    options_.replace = true;
    open();
    EXPECT_EQ(recorder_->startFromOptions().error().kind, ErrorKind::Refused);
}

TEST_F(LiveRecording, RecordingWithoutFramesFails) {
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    const auto state = recorder_->finish();
    ASSERT_TRUE(state);
    EXPECT_FALSE(state->active());
    EXPECT_EQ(state->failure(), "nothing was recorded: no frame has come");
    EXPECT_TRUE(std::filesystem::is_empty(options_.folder));
}

TEST_F(LiveRecording, FailsWhenTheFolderIsDeleted) {
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    std::filesystem::remove_all(options_.folder);
    v1::Recording state;
    for (int k = 0; k < 2000 && (k == 0 || state.active()); ++k) {
        if (const auto changed = recorder_->changedState(LiveRecorder::Clock::now())) state = *changed;
        std::this_thread::sleep_for(5ms);
    }
    EXPECT_FALSE(state.active());
    EXPECT_EQ(state.failure(), "was deleted while it was written, or its folder was; nothing of it is kept");
    EXPECT_TRUE(recorder_->start());  // in a new folder
}

TEST_F(LiveRecording, IgnoresKeyframesAndDiagnosticsForOthers) {
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    recorder_->publish(encoded(FrameKind::Delta, 0.1));
    for (int k = 0; k < 50; ++k) recorder_->publish(encoded(FrameKind::Resync, 0.1));
    v1::ServerMessage figures;
    figures.mutable_diagnostics();
    recorder_->broadcast(codec::share(figures));
    const auto state = recorder_->finish();
    ASSERT_TRUE(state);
    const auto file = RecordFile::open(state->file());
    int records = 0;
    for (std::uint64_t offset = fileHeadBytes;;) {
        const auto record = file->read(offset);
        if (!record) break;
        EXPECT_NE(record->kind, Kind::Resync);
        ++records;
        offset = record->end;
    }
    EXPECT_EQ(records, 6);  // source, scene, order, two frames, index
}

TEST_F(LiveRecording, TimeNeverDecreasesByRounding) {
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    const auto after = [](int steps) {
        double time = 0;
        for (int k = 0; k < steps; ++k) time += 1.0 / 60;
        return time;
    };
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    for (int last = 1; last < 60; ++last)
        for (int first = 0; first < last; ++first) {
            recorder_->publish(encoded(FrameKind::Delta, after(last)));
            recorder_->publish(encoded(FrameKind::Delta, after(first)));
        }
    EXPECT_EQ(recorder_->finish()->failure(), "");
}

TEST_F(LiveRecording, WritesNoRepeatedFramesWhilePaused) {
    open();
    order();
    ASSERT_TRUE(recorder_->start());
    const auto paused = [&](FrameKind kind, double time, std::uint32_t epoch = 1) {
        codec::EncodedFrame made = encoded(kind, time, epoch);
        v1::ServerMessage message = made.message->content();
        message.mutable_frame()->mutable_status()->set_paused(true);
        made.message = codec::share(std::move(message));
        recorder_->publish(made);
    };
    recorder_->publish(encoded(FrameKind::Keyframe, 0));
    recorder_->publish(encoded(FrameKind::Delta, 1));
    for (int k = 0; k < 5; ++k) paused(FrameKind::Delta, 1);
    EXPECT_FALSE(subscriptions()[0].lost) << "before the world goes on";
    paused(FrameKind::Resync, 1);
    recorder_->publish(encoded(FrameKind::Delta, 1));  // resumed, but still at the same step
    recorder_->publish(encoded(FrameKind::Delta, 2));
    EXPECT_TRUE(subscriptions()[0].lost);
    recorder_->publish(encoded(FrameKind::Resync, 2));
    recorder_->publish(encoded(FrameKind::Delta, 3));
    paused(FrameKind::Delta, 3);
    paused(FrameKind::Delta, 0);  // the world was reset
    retain(sceneMessage(2, spheres));
    order(2);
    paused(FrameKind::Keyframe, 0, 2);  // other spheres were loaded
    paused(FrameKind::Delta, 0.5, 2);   // the world was stepped
    paused(FrameKind::Resync, 0.5, 2);
    recorder_->publish(encoded(FrameKind::Delta, 0.75, 2));
    ASSERT_TRUE(recorder_->stop());
    auto recording = Recording::open(ended().file());
    ASSERT_TRUE(recording) << recording.error().text();
    std::vector<double> times;
    while (recording->next().value()) times.push_back(recording->time());
    EXPECT_EQ(times, (std::vector<double>{0, 1, 2, 3, 3.5, 3.75}));
}

TEST_F(LiveRecording, SceneNameCannotChangeTheFolder) {
    open();
    v1::ServerMessage scene = sceneMessage(1, spheres);
    scene.mutable_scene()->set_name("../../up/away\n;" + std::string(500, 'x'));
    retain(scene);
    order();
    ASSERT_TRUE(recorder_->start());
    const std::filesystem::path path = recorder_->changedState(LiveRecorder::Clock::now())->file();
    EXPECT_EQ(path.parent_path().string(), folder_ / "made");
    EXPECT_EQ(path.filename().string().find("upawayxxx"), 0U);
    EXPECT_LT(path.filename().string().size(), 80U);
}

}  // namespace
}  // namespace spherule::recording
