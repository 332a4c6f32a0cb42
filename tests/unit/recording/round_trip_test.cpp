// A recording plays the recorded frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "codec/order.h"
#include "recording_support.h"

namespace spherule::recording {
namespace {

constexpr double bound = Film::quantum / 2 + 1e-6;  // m

class RoundTrip : public testing::Test {
  protected:
    TemporaryFolder folder_;
    std::string path_ = folder_ / "film.sph";
};

TEST_F(RoundTrip, EveryFrameIsReadInIdOrderInMetres) {
    const Film film = recording::film(path_, 23);
    auto recording = Recording::open(path_);
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->frames(), 23U);
    EXPECT_EQ(recording->begin(), 0);
    EXPECT_DOUBLE_EQ(recording->end(), 2.2);
    EXPECT_EQ(recording->facts().name(), "film");
    EXPECT_EQ(recording->damage(), "");
    for (std::uint32_t n = 0; n < 23; ++n) {
        const auto more = recording->next();
        ASSERT_TRUE(more && *more) << n;
        const Snapshot now = recording->now();
        EXPECT_LE(distance({now.positions.begin(), now.positions.end()}, film.frames[n]), bound) << n;
        EXPECT_EQ(now.step, 6 * n);
        EXPECT_DOUBLE_EQ(now.time, 0.1 * n);
        EXPECT_EQ(now.error, Film::quantum / 2);
        EXPECT_EQ(now.spheres->radii[0], 1.5F);
        EXPECT_EQ(now.spheres->radii[69], 0.5F);
        EXPECT_EQ(std::ranges::count(now.spheres->groups, -1), 70) << "the film has no groups";
        EXPECT_EQ(std::ranges::count(now.spheres->materials, -1), 70);
    }
    EXPECT_FALSE(*recording->next());
}

TEST(SphereTable, HasTheGroupsThatFitTheSpheres) {
    v1::SceneFacts facts;
    facts.set_epoch(1);
    facts.set_count(6);
    facts.set_radius(1);
    for (auto* const corner : {facts.mutable_bounds_min(), facts.mutable_bounds_max()}) corner->Resize(3, 0);
    const auto add = [&facts](std::uint32_t first, std::uint32_t count) -> v1::GroupFacts& {
        v1::GroupFacts& group = *facts.add_groups();
        group.set_first(first);
        group.set_count(count);
        return group;
    };
    add(0, 2).set_material(3);
    add(2, 2);  // from a server that does not tell the material
    add(5, 2).set_material(1);
    add(7, 0xffffffffU).set_material(1);
    const std::vector<std::uint32_t> ids{0, 1, 2, 3, 4, 5};
    const auto table = SphereTable::from(facts, codec::orderMessage(1, 1, ids));
    ASSERT_TRUE(table) << table.error().text();
    EXPECT_EQ(table->groups, (std::vector<std::int32_t>{0, 0, 1, 1, -1, -1}));
    EXPECT_EQ(table->materials, (std::vector<std::int32_t>{3, 3, -1, -1, -1, -1}));
}

TEST_F(RoundTrip, FilePlaysWhileItIsWritten) {
    const Film film = recording::film(folder_ / "whole.sph", 1);
    auto writer = Writer::create(path_, false, Film::fileId);
    ASSERT_TRUE(writer);
    for (const std::string& record : film.records) ASSERT_TRUE(writer->add(kindOf(record), 0, payloadOf(record)));
    auto recording = Recording::open(path_);
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(recording->frames(), 1U);
}

TEST_F(RoundTrip, SeekFindsTheLastFrameNotAfterTheTime) {
    const Film film = recording::film(path_, 23);
    auto recording = Recording::open(path_);
    ASSERT_TRUE(recording);
    for (const double time : {1.0, 0.52, 2.2, 0.0, 1.49, -3.0, 99.0, 0.5}) {
        ASSERT_TRUE(recording->seek(time));
        const auto n = static_cast<std::size_t>(std::clamp(std::floor(time / 0.1 + 1e-6), 0.0, 22.0));
        const Snapshot now = recording->now();
        EXPECT_NEAR(now.time, 0.1 * static_cast<double>(n), 1e-12) << time;
        EXPECT_LE(distance({now.positions.begin(), now.positions.end()}, film.frames[n]), bound) << time;
        const auto rest = play(*recording);
        ASSERT_EQ(rest.size(), 22 - n) << time;
        for (std::size_t k = 0; k < rest.size(); ++k)
            EXPECT_LE(distance(rest[k], film.frames[n + 1 + k]), bound) << time;
    }
}

TEST_F(RoundTrip, SceneMayChange) {
    recording::film(path_, 3, false);
    std::string content = contentOf(path_);
    // The same records again, with another epoch and later times.
    std::vector<std::string> again = recordsOf(content);
    again.resize(3);  // scene, order and keyframe
    for (const std::string& record : again) {
        v1::ServerMessage message;
        ASSERT_TRUE(message.ParseFromString(std::string(payloadOf(record))));
        if (message.has_scene()) message.mutable_scene()->set_epoch(2);
        if (message.has_order()) message.mutable_order()->set_epoch(2);
        if (message.has_frame()) message.mutable_frame()->set_epoch(2);
        addRecord(content, kindOf(record), 5, message.SerializeAsString());
    }
    writeFile(path_, content);
    auto recording = Recording::open(path_);
    ASSERT_TRUE(recording) << recording.error().text();
    EXPECT_EQ(play(*recording).size(), 4U);
    EXPECT_EQ(recording->facts().epoch(), 2U);
    ASSERT_TRUE(recording->seek(0.1));
    EXPECT_EQ(recording->facts().epoch(), 1U);
    ASSERT_TRUE(recording->seek(7));
    EXPECT_EQ(recording->facts().epoch(), 2U);
}

TEST_F(RoundTrip, ExistingFileIsReplacedOnlyOnRequest) {
    writeFile(path_, "precious");
    const auto refused = Writer::create(path_, false, 1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text(), path_ + ": is there already; give --force to replace it, or another name");
    EXPECT_EQ(contentOf(path_), "precious");
    EXPECT_TRUE(Writer::create(path_, true, 1));
}

TEST_F(RoundTrip, ReportsPathAndReasonOfAWriteError) {
    EXPECT_EQ(Writer::create(folder_ / "no/film.sph", false, 1).error().text(),
              (folder_ / "no/film.sph") + ": cannot be written: No such file or directory; make its folder first");
    const auto full = Writer::create("/dev/full", true, 1);
    ASSERT_FALSE(full);
    EXPECT_EQ(full.error().kind, ErrorKind::Refused);
    EXPECT_EQ(full.error().text(),
              "/dev/full: writing failed after 0 bytes: No space left on device; make room there or write to "
              "another disk; what has been written stays as it is");
}

}  // namespace
}  // namespace spherule::recording
