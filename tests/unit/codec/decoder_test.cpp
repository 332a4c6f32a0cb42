// Sequences of frames: where a decoder may start, and the effect of a missed frame.
#include <gtest/gtest.h>

#include <algorithm>

#include "codec/decoder.h"
#include "codec_support.h"

namespace spherule::codec {
namespace {

constexpr std::uint32_t spheres = 2500;

struct CodecChain : testing::Test {
    std::vector<glm::ivec3> step() { return cells_ = motion_.next(); }
    Bytes next() { return encoder_.next(positionsAt(step())); }
    Bytes begin() { return encoder_.begin(positionsAt(step())); }

    void expectNow(const Decoder& decoder) const { EXPECT_TRUE(std::ranges::equal(decoder.newest(), cells_)); }

    static void expectRefusal(Decoder& decoder, const Bytes& frame, const std::string& text) {
        const auto got = decoder.apply(frame);
        ASSERT_FALSE(got);
        EXPECT_EQ(got.error().text(), text);
        EXPECT_TRUE(decoder.wantsKeyframe());
    }

    Encoder encoder_{"cpu:1", spheres};
    Motion motion_{spheres};
    std::vector<glm::ivec3> cells_;
};

TEST_F(CodecChain, ResyncContinuesWithSharedFrames) {
    Decoder first(spheres);
    ASSERT_TRUE(first.apply(begin()));
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(first.apply(next()));
    Decoder second(spheres);
    const auto joined = second.apply(encoder_.join());
    ASSERT_TRUE(joined);
    EXPECT_TRUE(joined->keyframe);
    EXPECT_EQ(joined->number, 6U);
    expectNow(second);
    for (int k = 0; k < 5; ++k) {
        const Bytes frame = next();
        ASSERT_TRUE(first.apply(frame));
        ASSERT_TRUE(second.apply(frame));
        expectNow(first);
        expectNow(second);
    }
    EXPECT_TRUE(std::ranges::equal(first.before(), second.before()));
}

TEST_F(CodecChain, RepeatedResyncsAreEqual) {
    begin();
    next();
    next();
    const Bytes once = encoder_.join();
    EXPECT_EQ(encoder_.join(), once);
}

TEST_F(CodecChain, DecoderNeedsAKeyframeAfterAMissedFrame) {
    Decoder decoder(spheres);
    ASSERT_TRUE(decoder.apply(begin()));
    next();
    expectRefusal(decoder, next(), "frame, head: is number 3, which does not follow 1");
    expectRefusal(decoder, next(), "frame, head: is no keyframe, and none came before");
    ASSERT_TRUE(decoder.apply(encoder_.join()));
    ASSERT_TRUE(decoder.apply(next()));
    expectNow(decoder);
}

TEST_F(CodecChain, DecoderAcceptsAKeyframeAtAnyTime) {
    Decoder decoder(spheres);
    ASSERT_TRUE(decoder.apply(begin()));
    ASSERT_TRUE(decoder.apply(next()));
    ASSERT_TRUE(decoder.apply(encoder_.join()));
    expectNow(decoder);
    ASSERT_TRUE(decoder.apply(begin()));
    expectNow(decoder);
    ASSERT_TRUE(decoder.apply(next()));
    expectNow(decoder);
}

TEST_F(CodecChain, DetectsAWrongHash) {
    Decoder decoder(spheres);
    ASSERT_TRUE(decoder.apply(begin()));
    Bytes frame = next();
    frame[12] ^= std::byte{1};
    expectRefusal(decoder, frame, "frame, head: has another hash than its positions");
}

TEST_F(CodecChain, RefusesAnotherNumberOfSpheres) {
    Decoder decoder(spheres + 1);
    expectRefusal(decoder, begin(), "frame, head: has 2500 spheres where there are 2501");
}

TEST_F(CodecChain, ReadsBackFramesOfAnyLength) {
    Decoder decoder(spheres);
    Motion large(40000);
    Encoder encoder("cpu:1", 40000);
    Decoder far(40000);
    for (int k = 0; k < 8; ++k) {
        // Spheres that rest for three frames make the fourth frame long.
        static Positions positions;
        if (k % 4 == 0) positions = positionsAt(large.next());
        const auto source = encoder.put(positions);
        k == 0 ? encoder.frames().encodeKeyframe(source) : encoder.frames().encodeDelta(source, k % 2 == 1);
        const auto frame = encoder.frames().poll();
        ASSERT_TRUE(frame) << "on the CPU device read-backs complete at once";
        EXPECT_EQ(*frame, encoder.frames().download());
        const auto head = far.apply(*frame);
        ASSERT_TRUE(head) << head.error().text();
        EXPECT_EQ(head->hash.has_value(), k % 2 == 1);
    }
}

}  // namespace
}  // namespace spherule::codec
