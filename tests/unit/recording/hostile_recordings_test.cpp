// Hostile files with correct checksums.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "recording/bytes.h"
#include "recording/record.h"
#include "recording_support.h"

namespace spherule::recording {
namespace {

class Hostile : public testing::Test {
  protected:
    // Returns why a file with these bytes after its head cannot be opened or played; empty if it can. Its records get
    // the checksums of their places.
    std::string refusalOf(const std::string& behindHead) {
        writeFile(path_, fileOf(behindHead));
        auto recording = Recording::open(path_);
        if (!recording) return recording.error().text().substr(path_.size() + 2);
        std::string end;
        play(*recording, &end);
        return end.empty() ? "" : end.substr(path_.size() + 2);
    }
    // Refusal of the film after `change` has modified the message of one record.
    std::string refusalWith(std::size_t changed, const std::function<void(v1::ServerMessage&)>& change) {
        std::string bytes;
        for (std::size_t record = 0; record < film_.records.size(); ++record) {
            const std::string& whole = film_.records[record];
            v1::ServerMessage message;
            message.ParseFromString(std::string(payloadOf(whole)));
            if (record == changed) change(message);
            bytes += unplaced(kindOf(whole), message.SerializeAsString());
        }
        const std::string refusal = refusalOf(bytes);
        const auto colon = refusal.find("damaged: ");
        return colon == std::string::npos ? refusal : refusal.substr(colon + 9);
    }

    // Returns a record at the time 0, without the checksum of a place.
    static std::string unplaced(Kind kind, std::string_view payload) { return recordBytes(kind, 0, payload, {}, 0); }

    TemporaryFolder folder_;
    std::string path_ = folder_ / "film.sph";
    Film film_ = film(folder_ / "good.sph", 3);
};

TEST_F(Hostile, RefusesOtherFiles) {
    const auto refusal = [&](const std::string& content) {
        writeFile(path_, content);
        return Recording::open(path_).error().text().substr(path_.size() + 2);
    };
    EXPECT_EQ(refusal("time,id,x,y,z,vx,vy,vz,radius\n"), "is no recording: it does not begin like one");
    EXPECT_EQ(refusal(""), "is no recording: it has only 0 bytes");
    EXPECT_EQ(refusal(FileHead().bytes()), "has no frames: it was not finished");
    EXPECT_EQ(refusal(FileHead{.version = 1}.bytes()), "has no frames: it was not finished");
    EXPECT_EQ(refusal(FileHead{.version = 3, .id = 7}.bytes()),
              "is of version 3 of the format; this program, spherule " SPHERULE_VERSION
              ", reads versions 1 and 2: use a newer spherule");
    EXPECT_EQ(refusal(FileHead{.version = 1, .id = 7}.bytes()), "is no recording: its head is damaged");
    EXPECT_EQ(refusal(FileHead{.version = 0}.bytes()), "is no recording: its head is damaged");
    EXPECT_EQ(Recording::open(folder_ / "none").error().text(), (folder_ / "none") + ": there is no such file");
    EXPECT_EQ(Recording::open("/tmp").error().text(), "/tmp: is a folder, must be a regular file");
}

TEST_F(Hostile, ChecksLengthsBeforeAllocating) {
    std::string record = film_.records.front();
    for (const std::uint32_t length : {mostPayload + 1, 0xffffffffU, 0x7fffffffU}) {
        record.replace(0, 4, std::string(reinterpret_cast<const char*>(&length), 4));
        EXPECT_EQ(refusalOf(record), "has no frames: the record at byte 16 is damaged: it is too long");
    }
    record.replace(0, 4, std::string("\xff\xff\xff\x3f", 4));
    EXPECT_EQ(refusalOf(record), "has no frames: the record at byte 16 is cut off");
}

TEST_F(Hostile, BoundsSpheresByFileSize) {
    EXPECT_EQ(refusalWith(0, [](auto& m) { m.mutable_scene()->set_count(4'000'000'000); }),
              "order: has 210 bytes for 4000000000 spheres");
    EXPECT_EQ(refusalWith(0, [](auto& m) { m.mutable_scene()->set_radii("abc"); }),
              "scene facts: have radii of other spheres");
    EXPECT_EQ(refusalWith(0, [](auto& m) { m.mutable_scene()->set_count(0); }), "scene facts: have no spheres");
    for (const float radius : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(), INFINITY}) {
        const std::vector<float> radii(Film::spheres, radius);
        EXPECT_EQ(refusalWith(0, [&](auto& m) { m.mutable_scene()->set_radii(radii.data(), 4 * radii.size()); }),
                  "scene facts: have a radius that is none");
    }
    EXPECT_EQ(refusalWith(0, [](auto& m) { m.mutable_scene()->set_radius(INFINITY); }),
              "scene facts: have a radius that is none");
    EXPECT_EQ(refusalWith(0, [](auto& m) { m.mutable_scene()->set_bounds_max(2, -5); }), "scene facts: have no bounds");
    EXPECT_EQ(refusalWith(0, [](auto& m) { m.mutable_scene()->clear_bounds_max(); }), "scene facts: have no bounds");
    EXPECT_EQ(refusalWith(1, [](auto& m) { m.mutable_order()->mutable_ids()->at(0) = 3; }),
              "order: is no permutation: place 66");
    EXPECT_EQ(refusalWith(1, [](auto& m) { m.mutable_order()->set_epoch(9); }),
              "scene facts: are of another epoch than the order");
}

TEST_F(Hostile, RefusesFramesOfOtherSpheres) {
    EXPECT_EQ(refusalWith(3, [](auto& m) { m.mutable_frame()->set_order(9); }),
              "its frame is of other spheres than scene and order before it");
    EXPECT_EQ(refusalWith(3, [](auto& m) { m.mutable_frame()->set_quantum(-1); }), "its frame has no quantum");
    EXPECT_EQ(refusalWith(3, [](auto& m) { m.mutable_frame()->set_spb("abc"); }), "frame, head: has 3 bytes of 16");
    EXPECT_EQ(refusalWith(3, [](auto& m) { m.mutable_settings(); }), "its message is of another kind");
    const auto& records = film_.records;
    EXPECT_NE(refusalOf(records[0] + records[1] + records[2] + records[4]).find("does not follow"), std::string::npos);
    EXPECT_NE(refusalOf(records[1] + records[2]).find("no scene or no order comes before"), std::string::npos);
    EXPECT_NE(refusalOf(records[0] + records[1] + records[3]).find("has no frames"), std::string::npos);
    EXPECT_NE(refusalOf(records[0] + records[1] + unplaced(Kind::Keyframe, "\xff")).find("no message"),
              std::string::npos);
}

// An invalid index is ignored; an index with wrong offsets ends in an error.
TEST_F(Hostile, DoesNotTrustTheIndex) {
    const std::string bytes = film_.records[0] + film_.records[1] + film_.records[2];
    const std::uint64_t at = fileHeadBytes + bytes.size();
    const auto refusal = [&](const Index& index) {
        std::string end = unplaced(Kind::Index, index.payload());
        append(end, at);
        end.append(endMagic.begin(), endMagic.end());
        return refusalOf(bytes + end);
    };
    Index good{.frames = 1, .entries = {}};
    std::uint64_t offset = fileHeadBytes;
    for (const Kind kind : {Kind::Scene, Kind::Order, Kind::Keyframe}) {
        good.entries.push_back({.offset = offset, .time = 0, .kind = kind});
        offset += film_.records[good.entries.size() - 1].size();
    }
    EXPECT_EQ(refusal(good), "");
    Index beyond = good;
    beyond.entries[2].offset = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(refusal(beyond), "");
    Index endless = good;
    endless.end = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(refusal(endless), "");
    Index astray = good;
    astray.entries[2].offset += 1;
    EXPECT_NE(refusal(astray), "");
    Index swapped = good;
    swapped.entries[1].kind = Kind::Scene;
    swapped.entries[0].kind = Kind::Order;
    EXPECT_NE(refusal(swapped), "");
    Index empty{.frames = 1, .entries = {}};
    EXPECT_EQ(refusal(empty), "has no frames");
}

}  // namespace
}  // namespace spherule::recording
