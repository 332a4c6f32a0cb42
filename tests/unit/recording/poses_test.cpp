// Recordings and exports have the poses of obstacles that move.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <glm/common.hpp>

#include "recording/bytes.h"
#include "recording/exporter.h"
#include "recording_support.h"

namespace spherule::recording {
namespace {

class Poses : public testing::Test {
  protected:
    void SetUp() override { filmWithObstacles(path_); }

    // Exports frames 0 to 11.
    void exportTo(const MadeExporter& exporter) {
        ASSERT_TRUE(exporter) << exporter.error().text();
        auto recording = Recording::open(path_);
        while (*recording->next()) ASSERT_TRUE((*exporter)->add(recording->now()));
        ASSERT_TRUE((*exporter)->finish());
    }

    TemporaryFolder folder_;
    std::string path_ = folder_ / "film.sph";
};

void expectFrame(Recording& recording, std::uint32_t n) {
    ASSERT_EQ(recording.step(), 6 * n);
    const Snapshot now = recording.now();
    ASSERT_EQ(now.poses.size(), 1U) << n;
    EXPECT_EQ(now.poses[0].SerializeAsString(), poseInFilm(n).SerializeAsString()) << n;
    EXPECT_EQ(now.facts->obstacles_size(), 2);
}

TEST_F(Poses, AreThoseOfTheFrameAlsoAfterASeek) {
    auto recording = Recording::open(path_);
    ASSERT_TRUE(recording) << recording.error().text();
    for (std::uint32_t n = 0; n < 12; ++n) {
        ASSERT_TRUE(*recording->next());
        expectFrame(*recording, n);
    }
    for (const std::uint32_t n : {3U, 11U, 5U, 0U}) {
        ASSERT_TRUE(recording->seek(0.1 * n));
        expectFrame(*recording, n);
    }
    ASSERT_TRUE(*recording->next());
    expectFrame(*recording, 1);
}

TEST_F(Poses, OfOtherObstaclesOrWithoutMeaningAreDamage) {
    const auto damage = [this](void (*change)(v1::Frame&)) {
        const std::string damaged = folder_ / "damaged.sph";
        const std::string whole = contentOf(path_);
        std::string content = whole.substr(0, fileHeadBytes);
        for (const std::string& record : recordsOf(whole)) {
            v1::ServerMessage message;
            message.ParseFromString(std::string(payloadOf(record)));
            if (message.has_frame()) change(*message.mutable_frame());
            addRecord(content, kindOf(record), timeOf(record), message.SerializeAsString());
        }
        writeFile(damaged, content);
        const auto recording = Recording::open(damaged);
        return recording ? "" : recording.error().message;
    };
    EXPECT_EQ(damage([](v1::Frame&) {}), "");
    EXPECT_EQ(damage([](v1::Frame& frame) { frame.clear_poses(); }), "");
    for (const auto change : {
             +[](v1::Frame& frame) { frame.mutable_poses(0)->set_obstacle(2); },
             +[](v1::Frame& frame) { *frame.add_poses() = frame.poses(0); },
             +[](v1::Frame& frame) { frame.mutable_poses(0)->add_translation(1); },
             +[](v1::Frame& frame) { frame.mutable_poses(0)->set_translation(1, NAN); },
             +[](v1::Frame& frame) { frame.mutable_poses(0)->set_rotation(3, 2); },
             +[](v1::Frame& frame) { frame.mutable_poses(0)->clear_rotation(); },
         })
        EXPECT_NE(damage(change).find("its frame has poses of other obstacles"), std::string::npos) << damage(change);
}

TEST_F(Poses, AreExportedAsCsv) {
    exportTo(posesExporter(folder_ / "poses.csv", false));
    const std::string table = contentOf(folder_ / "poses.csv");
    EXPECT_EQ(table.substr(0, table.find('\n')), "time,obstacle,x,y,z,qx,qy,qz,qw");
    EXPECT_NE(table.find("\n0,1,0,0,0,0,0,0,1\n"), std::string::npos) << table;
    EXPECT_NE(table.find("\n0.2,1,0,0.5,0,0,0,0.0998334166468,0.995004165278\n"), std::string::npos) << table;
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 13);
}

// Returns the least and the largest corner of the points in a file of VTK.
std::pair<glm::dvec3, glm::dvec3> boundsIn(const std::string& file) {
    const std::string content = contentOf(file);
    const std::size_t head = content.find("Name=\"Points\"");
    const std::size_t from = content.find("offset=\"", head) + 8;
    const std::size_t data = content.find("\n_") + 2 + std::stoul(content.substr(from));
    std::pair<glm::dvec3, glm::dvec3> ends{glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    const auto bytes = numberAt<std::uint64_t>(content, data);
    for (std::size_t at = 0; at < bytes; at += sizeof(glm::dvec3)) {
        const auto point = numberAt<glm::dvec3>(content, data + 8 + at);
        ends = {glm::min(ends.first, point), glm::max(ends.second, point)};
    }
    return ends;
}

TEST_F(Poses, ObstaclesAreExportedForVtk) {
    exportTo(vtkExporter(folder_ / "film.pvd", false));
    const std::string list = contentOf(folder_ / "film.pvd");
    EXPECT_NE(list.find("timestep=\"0.1\" part=\"1\" file=\"film/000000-obstacles.vtp\""), std::string::npos) << list;
    EXPECT_NE(list.find("timestep=\"0.1\" part=\"2\" file=\"film/000001-moving.vtp\""), std::string::npos) << list;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "film/000001-obstacles.vtp")) << "one file for obstacles at rest";
    const auto [low, high] = boundsIn(folder_ / "film/000000-obstacles.vtp");
    EXPECT_EQ(low, glm::dvec3(0, 1, 2.5));
    EXPECT_EQ(high, glm::dvec3(1, 2, 3.5));
    // The pose of frame 4 turns the cube by 0.4 rad about the z axis, and moves it by 1 m along y.
    const auto [left, right] = boundsIn(folder_ / "film/000004-moving.vtp");
    const double sine = std::sin(0.4);
    const double cosine = std::cos(0.4);
    EXPECT_NEAR(left.x, 2 * cosine - 2 * sine, 1e-12);
    EXPECT_NEAR(right.x, 3 * cosine - 1 * sine, 1e-12);
    EXPECT_NEAR(left.y, 1 + 2 * sine + 1 * cosine, 1e-12);
    EXPECT_NEAR(right.y, 1 + 3 * sine + 2 * cosine, 1e-12);
    EXPECT_EQ(left.z, 2.5);
}

}  // namespace
}  // namespace spherule::recording
