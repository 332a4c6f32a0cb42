#include "host/playback_producer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stop_token>
#include <string>
#include <vector>

#include "codec/order.h"
#include "codec_support.h"
#include "fake_publisher.h"
#include "recording/record.h"
#include "recording_support.h"

namespace spherule::host {
namespace {

using namespace std::chrono_literals;

// Adds the records of a scene and of a keyframe at `time` (s). All spheres have a radius of 0.5 m.
void addScene(std::string& file, std::uint32_t spheres, std::uint32_t epoch, double time) {
    v1::ServerMessage scene;
    scene.mutable_scene()->set_epoch(epoch);
    scene.mutable_scene()->set_count(spheres);
    scene.mutable_scene()->set_radius(0.5F);
    for (int axis = 0; axis < 3; ++axis) {
        scene.mutable_scene()->add_bounds_min(0);
        scene.mutable_scene()->add_bounds_max(8);
    }
    codec::Encoder encoder("cpu", spheres, 0.125);
    const auto bytes = encoder.begin(codec::Positions(spheres));
    std::vector<std::uint32_t> ids(spheres);
    for (std::uint32_t id = 0; id < spheres; ++id) ids[id] = id;
    v1::ServerMessage order;
    *order.mutable_order() = codec::orderMessage(epoch, 1, ids);
    v1::ServerMessage message;
    v1::Frame& frame = *message.mutable_frame();
    frame.set_epoch(epoch);
    frame.set_order(1);
    frame.set_quantum(0.125);
    frame.set_count(spheres);
    frame.set_spb(bytes.data(), bytes.size());
    recording::addRecord(file, recording::Kind::Scene, time, scene.SerializeAsString());
    recording::addRecord(file, recording::Kind::Order, time, order.SerializeAsString());
    recording::addRecord(file, recording::Kind::Keyframe, time, message.SerializeAsString());
}

// Plays a recording in a loop. Keeps the messages that a viewer receives.
class Playback : private FakePublisher {
  public:
    std::vector<v1::SceneFacts> scenes;
    std::vector<v1::Frame> frames;

    // Plays until the scene has changed `changes` times.
    void play(const std::string& path, std::size_t changes) {
        changes_ = changes;
        run(path);
    }
    // Plays until there are `count` frames.
    void playFrames(const std::string& path, std::size_t count) {
        count_ = count;
        run(path);
    }

  private:
    void run(const std::string& path) {
        Player player(std::move(*recording::Recording::open(path)), "film.sph", true, Player::Clock::now());
        PlaybackProducer producer(std::move(*compute::openDevice("cpu:1")), std::move(player),
                                  {requests_, board_, *this, saver_});
        EXPECT_TRUE(producer.run(stop_.get_token()));
    }
    void retain(codec::SharedMessage message, codec::Audience) override {
        if (message->content().has_scene()) scenes.push_back(message->content().scene());
        if (scenes.size() > changes_) stop_.request_stop();
    }
    void publish(const codec::EncodedFrame& encoded) override {
        frames.push_back(encoded.message->content().frame());
        if (frames.size() >= count_) stop_.request_stop();
    }
    [[nodiscard]] std::uint32_t viewers() const override { return 1; }
    [[nodiscard]] std::vector<codec::Subscription> subscriptions() override {
        return {{.rendition = {v1::NORMAL, 60}, .newcomer = true}};
    }

    std::size_t changes_ = SIZE_MAX;
    std::size_t count_ = SIZE_MAX;
    Requests requests_;
    SceneSaver saver_;
    StatusBoard board_;
    std::stop_source stop_;
};

TEST(PlaybackProducer, ShowsScenesInSequenceWithAnyEpochNumbers) {
    for (const std::uint32_t second : {1U, 2U}) {
        const recording::TemporaryFolder folder;
        const std::string path = folder / "film.sph";
        std::string film = recording::FileHead().bytes();
        addScene(film, 2, 1, 0);
        addScene(film, 5, second, 0.1);
        addScene(film, 3, second, 0.2);
        recording::writeFile(path, film);
        Playback playback;
        playback.play(path, 6);
        ASSERT_EQ(playback.scenes.size(), 7U);
        // When the thread is delayed, it continues with the scene that is then due.
        const std::vector<std::uint32_t> counts = {2, 5, 3};
        std::size_t next = 0;
        for (std::size_t k = 0; k < playback.scenes.size(); ++k) {
            EXPECT_EQ(playback.scenes[k].epoch(), k + 1);
            const auto place = std::ranges::find(counts, playback.scenes[k].count()) - counts.begin();
            ASSERT_LT(place, 3) << playback.scenes[k].count();
            EXPECT_TRUE(k == 0 ? place == 0 : playback.scenes[k].count() != playback.scenes[k - 1].count());
            next += static_cast<std::size_t>(place) == k % 3 ? 1 : 0;
        }
        EXPECT_GT(next, 0U);
        ASSERT_FALSE(playback.frames.empty());
        for (const v1::Frame& frame : playback.frames)
            EXPECT_EQ(frame.count(), playback.scenes.at(frame.epoch() - 1).count()) << "of epoch " << frame.epoch();
    }
}

TEST(PlaybackProducer, FramesHaveThePosesOfTheRecordedFrame) {
    const recording::TemporaryFolder folder;
    recording::filmWithObstacles(folder / "film.sph");
    Playback playback;
    playback.playFrames(folder / "film.sph", 20);
    for (const v1::Frame& frame : playback.frames) {
        ASSERT_EQ(frame.poses_size(), 1);
        const v1::Pose expected = recording::poseInFilm(static_cast<std::uint32_t>(frame.step() / 6));
        EXPECT_EQ(frame.poses(0).SerializeAsString(), expected.SerializeAsString()) << frame.step();
    }
    EXPECT_NE(playback.frames.front().step(), playback.frames.back().step());
}

}  // namespace
}  // namespace spherule::host
