// Hand-written, invalid and garbled frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "codec/decoder.h"
#include "codec_support.h"

namespace spherule::codec {
namespace {

// Makes a frame from words of 32 bits.
Bytes frameOf(std::vector<std::uint32_t> words) {
    const auto bytes = std::as_bytes(std::span(words));
    return {bytes.begin(), bytes.end()};
}

constexpr std::uint32_t delta = 0x00015053;
constexpr std::uint32_t key = 0x01015053;

// A keyframe of one block: no value bits, base 5, 6, -7.
const std::vector<std::uint32_t> still{key, 64, 1, 0, 6, 1, 0x000f, 0x00000000, 5, 6, 0xfffffff9U};

std::string refusal(Decoder& decoder, const std::vector<std::uint32_t>& words) {
    const auto got = decoder.apply(frameOf(words));
    return got ? "" : got.error().text();
}

// Decodes `still`, then a delta frame of one block with these words as its group.
std::string refusalOf(std::vector<std::uint32_t> group) {
    Decoder decoder(64);
    EXPECT_EQ(refusal(decoder, still), "");
    std::vector<std::uint32_t> words{delta, 64, 2, 0, static_cast<std::uint32_t>(group.size())};
    words.insert(words.end(), group.begin(), group.end());
    return refusal(decoder, words);
}

TEST(CodecHostile, DecodesAHandWrittenFrame) {
    Decoder decoder(64);
    ASSERT_EQ(refusal(decoder, still), "");
    EXPECT_TRUE(std::ranges::all_of(decoder.newest(), [](auto q) { return q == glm::ivec3(5, 6, -7); }));
}

TEST(CodecHostile, DecodesAHandWrittenMask) {
    Decoder decoder(64);
    ASSERT_EQ(refusal(decoder, still), "");
    // Header: mask, previous, widths 1 0 2. Then the changed runs of x, y, z. Then the changed values of runs 0 and 5
    // of x, 5 of y, 5 of z. Then the values: x 0 and 1 (for 1 and 2), y none (for 1), z 2 (for 3).
    ASSERT_EQ(refusal(decoder, {delta, 64, 2, 0, 4, 1, 0x20212011, 0x01010220, 0x00000a01}), "");
    EXPECT_EQ(decoder.newest()[0], glm::ivec3(5, 6, -7));
    EXPECT_EQ(decoder.newest()[1], glm::ivec3(4, 6, -7));
    EXPECT_EQ(decoder.newest()[40], glm::ivec3(6, 5, -9));
}

TEST(CodecHostile, ReportsDefectAndPlace) {
    Decoder decoder(64);
    EXPECT_EQ(decoder.apply(Bytes(15)).error().text(), "frame, head: has 15 bytes of 16");
    EXPECT_EQ(refusal(decoder, {0x00025053, 64, 1, 0}), "frame, head: is not a head of codec SPB, version 1");
    EXPECT_EQ(refusal(decoder, {0x08015053, 64, 1, 0}), "frame, head: is not a head of codec SPB, version 1");
    EXPECT_EQ(refusal(decoder, {key, 0, 1, 0}), "frame, head: has no spheres");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0}), "frame, table: goes beyond the end");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0, 0xffffffff}), "frame, chunk 0: ends outside of the frame");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0, 0}), "frame, group of block 0: goes beyond its chunk");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0, 1, 2}), "frame, group of block 0: has blocks that do not exist");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0, 1, 0}), "frame, block 0: is missing in a keyframe");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0, 1, 1}), "frame, block 0: goes beyond its chunk");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0, 2, 1, 0}), "frame, block 0: is predicted in a keyframe");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0, 2, 1, 0x000c}), "frame, block 0: has no base");
    EXPECT_EQ(refusalOf({1, 0xfff0}), "frame, block 0: goes beyond its chunk");
    EXPECT_EQ(refusalOf({1, 0x000f, 0, 0, 0, 0}), "frame, block 0: is not predicted in a delta frame");
    EXPECT_EQ(refusalOf({1, 0x0004}), "frame, block 0: is predicted from a velocity right after a keyframe");
    EXPECT_EQ(refusalOf({1, 0, 0}), "frame, chunk 0: does not end where its groups do");
    EXPECT_EQ(refusal(decoder, {key, 64, 1, 0, 6, 1, 0x000f, 0, 5, 6, 7, 8}),
              "frame, end: differs from the end of the last chunk");
    Bytes ragged = frameOf(still);
    ragged.push_back({});
    EXPECT_EQ(decoder.apply(ragged).error().text(), "frame, end: is no whole word");
    EXPECT_EQ(refusalOf({0}), "");
}

TEST(CodecHostile, SurvivesTruncatedAndGarbledFrames) {
    constexpr std::uint32_t spheres = 5000;
    Encoder encoder("cpu:1", spheres);
    Motion motion(spheres);
    std::vector<Bytes> frames{encoder.begin(positionsAt(motion.next()))};
    for (int k = 0; k < 3; ++k) frames.push_back(encoder.next(positionsAt(motion.next())));
    std::mt19937 random(6);
    unsigned refused = 0;
    for (int round = 0; round < 300; ++round) {
        Decoder decoder(spheres);
        for (const Bytes& frame : frames) {
            Bytes garbled = frame;
            for (unsigned k = random() % 4; k > 0; --k)
                garbled[random() % garbled.size()] ^= std::byte(1U << random() % 8);
            if (random() % 4 == 0) garbled.resize(random() % garbled.size());
            if (!decoder.apply(garbled)) ++refused;
        }
    }
    EXPECT_GT(refused, 300U);
}

}  // namespace
}  // namespace spherule::codec
