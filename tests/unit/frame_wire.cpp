#include "frame/wire.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace spherule::frame {
namespace {

const scene::Bounds boundsOfBox{.min = {-2, -1, 10}, .max = {4, 3, 12}};

double cell(double position, double origin, double quantum) {
    return std::clamp(std::round((position - origin) / quantum), 0.0, 65535.0);
}

// The plain meaning of packed16, written apart from the code under test.
std::vector<std::byte> pack(const std::vector<glm::dvec3>& positions, const v1::WireGrid& grid) {
    std::vector<std::byte> bytes;
    const auto put = [&](double value) {
        const auto whole = static_cast<unsigned>(value);
        bytes.push_back(static_cast<std::byte>(whole % 256));
        bytes.push_back(static_cast<std::byte>(whole / 256));
    };
    for (const glm::dvec3& p : positions) {
        put(cell(p.x, grid.origin_x(), grid.quantum()));
        put(cell(p.y, grid.origin_y(), grid.quantum()));
        put(cell(p.z, grid.origin_z(), grid.quantum()));
    }
    bytes.resize(packedBytes(static_cast<std::uint32_t>(positions.size())));
    return bytes;
}

v1::Frame frameOf(const std::vector<glm::dvec3>& positions, const v1::WireGrid& grid) {
    v1::Frame frame;
    frame.set_count(static_cast<std::uint32_t>(positions.size()));
    *frame.mutable_states() = statesOf(pack(positions, grid));
    return frame;
}

TEST(WireGrid, IsAsFineAsTheLargerOfRadiusAndBoundsAsk) {
    EXPECT_DOUBLE_EQ(wireGridFor(boundsOfBox, 0.25).quantum(), 0.25 / 250);
    EXPECT_DOUBLE_EQ(wireGridFor(boundsOfBox, 0.001).quantum(), 1.5 * 6 / 65535);
}

TEST(WireGrid, CoversTheBoundsWithRoomOnAllSides) {
    const auto grid = wireGridFor(boundsOfBox, 0.001);
    const double far = 65535 * grid.quantum();
    const glm::dvec3 origin(grid.origin_x(), grid.origin_y(), grid.origin_z());
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(origin[axis], boundsOfBox.min[axis] - 1.49);
        EXPECT_GE(origin[axis] + far, boundsOfBox.max[axis] + 1.49);
    }
}

TEST(WireGrid, HasAPointAtTheCentreOfTheBounds) {
    const auto grid = wireGridFor(boundsOfBox, 0.037);
    const auto centre = positionsOf(frameOf({boundsOfBox.centre()}, grid), grid);
    ASSERT_TRUE(centre);
    EXPECT_EQ((*centre)[0], boundsOfBox.centre());
}

TEST(Wire, PacksWholeBlocks) {
    EXPECT_EQ(packedBytes(0), 0U);
    EXPECT_EQ(packedBytes(1), 384U);
    EXPECT_EQ(packedBytes(64), 384U);
    EXPECT_EQ(packedBytes(65), 768U);
    EXPECT_EQ(packedBytes(4'000'000'000U), 24'000'000'000U);
}

TEST(Wire, GivesPositionsBackWithinHalfAQuantum) {
    const auto grid = wireGridFor(boundsOfBox, 0.01);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> spread(-1.4, 1.4);
    std::vector<glm::dvec3> positions(1000);
    for (glm::dvec3& p : positions) {
        p = boundsOfBox.centre() + 3.0 * glm::dvec3(spread(random), spread(random), spread(random));
    }
    const auto got = positionsOf(frameOf(positions, grid), grid);
    ASSERT_TRUE(got);
    ASSERT_EQ(got->size(), positions.size());
    const double bound = grid.quantum() / 2 * (1 + 1e-9);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR((*got)[i][axis], positions[i][axis], bound);
    }
}

TEST(Wire, RefusesAFrameWhoseBytesDoNotFitItsCount) {
    const auto grid = wireGridFor(boundsOfBox, 0.01);
    auto frame = frameOf({boundsOfBox.centre()}, grid);
    frame.set_count(65);
    const auto got = positionsOf(frame, grid);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().text(), "frame.states.packed16.positions: has 384 bytes where 65 spheres take 768");
}

TEST(Wire, RefusesACodecThatItDoesNotKnow) {
    const auto got = positionsOf(v1::Frame(), v1::WireGrid());
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().where, "frame.states");
}

}  // namespace
}  // namespace spherule::frame
