// The decoder restores the positions that the encoder has encoded on the CPU device.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "codec/block.h"
#include "codec/decoder.h"
#include "codec/rendition.h"
#include "codec_support.h"

namespace spherule::codec {
namespace {

std::vector<glm::ivec3> decoded(Decoder& decoder, const Bytes& frame) {
    const auto head = decoder.apply(frame);
    if (!head) {
        ADD_FAILURE() << head.error().text();
        return {};
    }
    return {decoder.newest().begin(), decoder.newest().end()};
}

class CodecCounts : public testing::TestWithParam<std::uint32_t> {};

TEST_P(CodecCounts, AnyMotionIsDecodedExactly) {
    const std::uint32_t spheres = GetParam();
    Encoder encoder("cpu:1", spheres);
    Decoder decoder(spheres);
    Motion motion(spheres);
    const auto first = motion.next();
    EXPECT_EQ(decoded(decoder, encoder.begin(positionsAt(first))), first);
    for (int frame = 0; frame < 30; ++frame) {
        const auto cells = motion.next();
        ASSERT_EQ(decoded(decoder, encoder.next(positionsAt(cells))), cells) << "frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Spheres, CodecCounts,
                         testing::Values(1, 2, 63, 64, 65, 127, 128, 2047, 2048, 2049, 16383, 16384, 16385, 70001));

// Ensures that the test above covers every case.
TEST(Codec, EveryModePredictorAndWidthIsUsed) {
    constexpr std::uint32_t spheres = 64 * 32;
    Encoder encoder("cpu:1", spheres);
    Motion motion(spheres, 3);
    std::set<int> modes, predictors, codes;
    encoder.begin(positionsAt(motion.next()));
    for (int frame = 0; frame < 60; ++frame) {
        const Bytes bytes = encoder.next(positionsAt(motion.next()));
        std::vector<std::uint32_t> words(bytes.size() / 4 + 2);
        std::memcpy(words.data(), bytes.data(), bytes.size());
        std::size_t unit = 2 * (4 + 1 + 1);  // behind head, table and bitmap
        for (std::uint32_t rest = words[5]; rest != 0; rest &= rest - 1) {
            const std::uint32_t header = words[unit / 2] >> 16 * (unit % 2) & 0xffffU;
            codec::Block block;
            ASSERT_TRUE(block.read(words, unit, bytes.size() / 2));
            unit = block.end();
            modes.insert(static_cast<int>(block.mode()));
            predictors.insert(static_cast<int>(block.predictor()));
            for (unsigned axis = 0; axis < 3; ++axis) codes.insert(header >> (4 + 4 * axis) & 15U);
        }
    }
    EXPECT_EQ(modes.size(), 4U);
    EXPECT_EQ(predictors.size(), 3U);
    EXPECT_EQ(codes, (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}));
}

TEST(Codec, ClampsPositionsToTheGrid) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr int edge = 1 << 30;
    Encoder encoder("cpu:1", 3, 0.5);
    Decoder decoder(3);
    const Positions wild{{inf, -inf, nan, 1}, {3e38F, -3e38F, -nan, 1}, {1e9F, -1e9F, 0.26F, 1}};
    const std::vector<glm::ivec3> cells{{edge, -edge, -edge}, {edge, -edge, -edge}, {edge, -edge, 1}};
    EXPECT_EQ(decoded(decoder, encoder.begin(wild)), cells);
    const Positions tame{{0, 0, 0, 1}, {0.24F, 0.25F, -0.25F, 1}, {1, 2, 3, 1}};
    const std::vector<glm::ivec3> tameCells{{0, 0, 0}, {0, 1, 0}, {2, 4, 6}};
    EXPECT_EQ(decoded(decoder, encoder.next(tame)), tameCells);
    EXPECT_EQ(decoded(decoder, encoder.next(wild)), cells);
    EXPECT_EQ(decoded(decoder, encoder.next(tame)), tameCells);
    EXPECT_EQ(decoded(decoder, encoder.next(wild)), cells);
}

TEST(Codec, AppliesOriginAndQuantum) {
    constexpr double quantum = 0.00064;
    constexpr glm::vec3 origin(-1.5F, 2, 0.125F);
    Encoder encoder("cpu:1", 1000, quantum, origin);
    Decoder decoder(1000);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> place(-3, 3);
    Positions positions(1000);
    for (auto& p : positions) p = glm::vec4(place(random), place(random), place(random), 1);
    const auto cells = decoded(decoder, encoder.begin(positions));
    ASSERT_EQ(cells.size(), 1000U);
    for (std::size_t k = 0; k < cells.size(); ++k) {
        EXPECT_EQ(cells[k], onGrid(positions[k], quantum, origin));
        for (int axis = 0; axis < 3; ++axis) {
            const double x = static_cast<double>(origin[axis]) + quantum * cells[k][axis];
            EXPECT_NEAR(x, static_cast<double>(positions[k][axis]), quantum * 0.501);
        }
    }
}

// Speeds from far below the unit to far above it, in all directions.
TEST(Codec, SpeedsAreWithinOnePercent) {
    constexpr double unit = 0.0005;  // m/s
    constexpr std::uint32_t spheres = 4000;
    Encoder encoder("cpu:1", spheres, {.quantum = unit, .quantity = v1::SPEED});
    Decoder decoder(spheres);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> exponent(-6, 12);
    std::normal_distribution<double> part;
    Positions velocities(spheres);
    std::vector<double> speeds(spheres);
    const auto draw = [&] {
        for (std::uint32_t k = 0; k < spheres; ++k) {
            const glm::dvec3 way(part(random), part(random), part(random));
            const glm::vec3 v(way / glm::length(way) * std::pow(10.0, exponent(random)));
            velocities[k] = glm::vec4(v, k % 2 == 0 ? -1 : 1);
            speeds[k] = glm::length(glm::dvec3(v));
        }
        velocities[7] = glm::vec4(0, 0, 0, 1);
        speeds[7] = 0;
    };
    for (int frame = 0; frame < 5; ++frame) {
        draw();
        const auto codes = decoded(decoder, frame == 0 ? encoder.begin(velocities) : encoder.next(velocities));
        ASSERT_EQ(codes.size(), spheres);
        for (std::uint32_t k = 0; k < spheres; ++k) {
            EXPECT_EQ(codes[k].y, 0);
            EXPECT_EQ(codes[k].z, 0);
            const double found = valueOf(static_cast<std::uint32_t>(codes[k].x), unit);
            EXPECT_NEAR(found, speeds[k], 0.008 * speeds[k] + unit / 64) << k;
        }
        EXPECT_EQ(codes[7].x, 0);
    }
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (auto& v : velocities) v = glm::vec4(nan, 0, 0, 1);
    EXPECT_FALSE(
        std::isfinite(valueOf(static_cast<std::uint32_t>(decoded(decoder, encoder.next(velocities))[0].x), unit)));
}

TEST(Codec, NumbersOfContactsAreExact) {
    constexpr std::uint32_t spheres = 62;
    const double unit = unitOf(v1::CONTACTS, 0.05);
    Encoder encoder("cpu:1", spheres, {.quantum = unit, .quantity = v1::CONTACTS});
    Decoder decoder(spheres);
    Positions rows(spheres);
    for (std::uint32_t k = 0; k < spheres; ++k) rows[k] = glm::vec4(k, 0.5, 7, 0);
    const auto codes = decoded(decoder, encoder.begin(rows));
    for (std::uint32_t k = 0; k < spheres; ++k)
        EXPECT_EQ(std::lround(valueOf(static_cast<std::uint32_t>(codes[k].x), unit)), k);
}

// The other components of a row. Energies reach far below the square root of the smallest float.
TEST(Codec, OverlapsAndEnergiesAreWithinOnePercent) {
    constexpr std::uint32_t spheres = 2000;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> exponent(-6, 3);
    for (const auto& [quantity, radius] : {std::pair(v1::OVERLAP, 0.05), {v1::ENERGY, 0.05}, {v1::ENERGY, 1e-6}}) {
        const double unit = unitOf(quantity, radius);
        Encoder encoder("cpu:1", spheres, {.quantum = unit, .quantity = quantity});
        Decoder decoder(spheres);
        Positions rows(spheres);
        for (glm::vec4& row : rows) {
            row = glm::vec4(3);
            row[quantity == v1::OVERLAP ? 1 : 2] = static_cast<float>(unit * std::pow(10, exponent(random)));
        }
        const auto codes = decoded(decoder, encoder.begin(rows));
        for (std::uint32_t k = 0; k < spheres; ++k) {
            const auto value = static_cast<double>(rows[k][quantity == v1::OVERLAP ? 1 : 2]);
            EXPECT_NEAR(valueOf(static_cast<std::uint32_t>(codes[k].x), unit), value, 0.008 * value + unit / 64);
        }
    }
}

// Components of both signs, from far below the unit to far above it.
TEST(Codec, SpinsAreWithinTheirBound) {
    constexpr double unit = spinUnit;  // rad/s
    constexpr std::uint32_t spheres = 4000;
    Encoder encoder("cpu:1", spheres, {.quantum = unit, .spins = true});
    Decoder decoder(spheres);
    std::mt19937 random(6);
    std::uniform_real_distribution<double> exponent(-4, 5);
    std::bernoulli_distribution negative;
    Positions spins(spheres);
    for (int frame = 0; frame < 5; ++frame) {
        for (glm::vec4& spin : spins)
            for (int axis = 0; axis < 4; ++axis)
                spin[axis] = static_cast<float>((negative(random) ? -1 : 1) * std::pow(10.0, exponent(random)));
        spins[7] = glm::vec4(0, -0.0F, 0.06F, 1);
        const auto codes = decoded(decoder, frame == 0 ? encoder.begin(spins) : encoder.next(spins));
        ASSERT_EQ(codes.size(), spheres);
        for (std::uint32_t k = 0; k < spheres; ++k)
            for (int axis = 0; axis < 3; ++axis) {
                const auto exact = static_cast<double>(spins[k][axis]);
                const double most = std::abs(exact) / 32 + unit / (std::abs(exact) < unit / 16 ? 16 : 32);
                ASSERT_NEAR(spinOf(codes[k][axis], unit), exact, most * 1.0001) << k << ", axis " << axis;
            }
        EXPECT_EQ(codes[7], glm::ivec3(0));
    }
}

TEST(Codec, KeepsTheOrderOfSpheres) {
    constexpr std::uint32_t spheres = 3000;
    Encoder encoder("cpu:1", spheres);
    std::vector<std::uint32_t> order(spheres);
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::shuffle(order, std::mt19937(5));
    encoder.setOrder(order);
    Motion motion(spheres);
    Decoder decoder(spheres);
    const auto byId = motion.next();
    const auto cells = decoded(decoder, encoder.begin(positionsAt(byId)));
    ASSERT_EQ(cells.size(), byId.size());
    for (std::uint32_t k = 0; k < spheres; ++k) ASSERT_EQ(cells[k], byId[order[k]]);
}

TEST(Codec, SpheresAtRestCostOneBitPerBlock) {
    constexpr std::uint32_t spheres = 2048 * 8 * 2;
    Encoder encoder("cpu:1", spheres);
    Motion motion(spheres);
    const Positions positions = positionsAt(motion.next());
    encoder.begin(positions);
    EXPECT_EQ(encoder.next(positions).size(), 4U * (4 + 2 + 16));
}

}  // namespace
}  // namespace spherule::codec
