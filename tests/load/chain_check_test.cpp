// Tests of ChainCheck: it accepts valid message sequences only.
#include "chain_check.h"

#include <cstring>
#include <string>

#include <gtest/gtest.h>

namespace spherule::load {
namespace {

using testing::AssertionFailure;
using testing::AssertionResult;
using testing::AssertionSuccess;

constexpr std::uint32_t spheres = 2;

std::string bytesOf(const std::vector<std::uint32_t>& words) {
    std::string bytes(words.size() * sizeof(std::uint32_t), '\0');
    std::memcpy(bytes.data(), words.data(), bytes.size());
    return bytes;
}

constexpr std::uint32_t head = 0x00015053;  // without flags
constexpr std::uint32_t keyframeFlag = 1U << 24U;
constexpr std::uint32_t hashFlag = 1U << 25U;

// docs/codec.md: mode 3, predictor 3, all widths 0: all spheres at the base; three words.
std::string keyframe(std::uint32_t number, std::uint32_t x = 7) {
    const std::uint32_t header = 3U | 3U << 2U;
    // Bitmap of the group; then units: header, 3 of selectors, 6 of the base, no values.
    const std::vector<std::uint32_t> units = {header, 0, 0, 0, x, 0, 0, 0, 0, 0};
    std::vector<std::uint32_t> words = {head | keyframeFlag, spheres, number, 0, 6, 1};
    for (std::size_t k = 0; k < units.size(); k += 2) words.push_back(units[k] | units[k + 1] << 16U);
    return bytesOf(words);
}

// One group without blocks: no sphere has moved.
std::string delta(std::uint32_t number) {
    return bytesOf({head, spheres, number, 0, 1, 0});
}

class ChainCheckTest : public testing::Test {
  protected:
    AssertionResult fine(const v1::ServerMessage& message) {
        const auto fault = check_.take(message);
        return fault ? AssertionFailure() << *fault : AssertionSuccess();
    }
    AssertionResult faulty(const v1::ServerMessage& message, const std::string& what) {
        const auto fault = check_.take(message);
        if (!fault) return AssertionFailure() << "no fault is reported";
        if (fault->find(what) == std::string::npos) return AssertionFailure() << *fault;
        return AssertionSuccess();
    }

    static v1::ServerMessage facts(std::uint32_t epoch) {
        v1::ServerMessage message;
        message.mutable_scene()->set_epoch(epoch);
        message.mutable_scene()->set_count(spheres);
        return message;
    }
    static v1::ServerMessage order(std::uint32_t epoch, const std::string& ids = {"\1\0\0\0\0\0", 6}) {
        v1::ServerMessage message;
        message.mutable_order()->set_epoch(epoch);
        message.mutable_order()->set_number(epoch);
        message.mutable_order()->set_ids(ids);
        return message;
    }
    static v1::ServerMessage stream(v1::Tier tier = v1::NORMAL) {
        v1::ServerMessage message;
        message.mutable_stream()->set_tier(tier);
        message.mutable_stream()->set_rate(20);
        return message;
    }
    v1::ServerMessage frame(const std::string& spb, std::uint32_t epoch = 1, v1::Tier tier = v1::NORMAL) {
        v1::ServerMessage message;
        v1::Frame& made = *message.mutable_frame();
        made.set_sequence(++sequence_);
        made.set_epoch(epoch);
        made.set_order(epoch);
        made.set_count(spheres);
        made.set_tier(tier);
        made.set_quantum(0.001);
        made.set_stamp_us(1);
        made.set_spb(spb);
        return message;
    }
    void greet() {
        v1::ServerMessage welcome;
        welcome.mutable_welcome();
        ASSERT_TRUE(fine(welcome));
        ASSERT_TRUE(fine(stream()));
        ASSERT_TRUE(fine(facts(1)));
        ASSERT_TRUE(fine(order(1)));
    }

    ChainCheck check_{true};
    std::uint64_t sequence_ = 0;
};

TEST_F(ChainCheckTest, AcceptsKeyframesAndDeltas) {
    greet();
    EXPECT_TRUE(fine(frame(keyframe(5))));
    EXPECT_TRUE(fine(frame(delta(6))));
    EXPECT_TRUE(fine(frame(keyframe(9))));
    EXPECT_TRUE(fine(frame(delta(10))));
    const Received& received = check_.received();
    EXPECT_EQ(received.frames, 4U);
    EXPECT_EQ(received.keyframes, 2U);
    EXPECT_EQ(received.chains, 1U);
    EXPECT_EQ(received.losses, 1U);
    EXPECT_EQ(received.missed, 2U);
}

TEST_F(ChainCheckTest, RejectsADeltaThatDoesNotFollow) {
    greet();
    EXPECT_TRUE(faulty(frame(delta(5)), "before a keyframe"));
    EXPECT_TRUE(fine(frame(keyframe(5))));
    EXPECT_TRUE(faulty(frame(delta(7)), "delta frame 7 after 5"));
    EXPECT_TRUE(faulty(frame(delta(5)), "delta frame 5 after 5"));
    EXPECT_TRUE(faulty(frame(keyframe(4)), "a keyframe of number 4 after 5"));
}

TEST_F(ChainCheckTest, RequiresAKeyframeAfterAStreamOrEpochChange) {
    greet();
    EXPECT_TRUE(fine(frame(keyframe(5))));
    EXPECT_TRUE(fine(stream(v1::ECO)));
    EXPECT_TRUE(faulty(frame(delta(6)), "of tier NORMAL on a stream of ECO"));
    EXPECT_TRUE(faulty(frame(delta(6), 1, v1::ECO), "before a keyframe"));
    EXPECT_TRUE(fine(frame(keyframe(1), 1, v1::ECO)));
    EXPECT_TRUE(fine(facts(2)));
    EXPECT_TRUE(fine(order(2)));
    EXPECT_TRUE(fine(frame(delta(2), 1, v1::ECO))) << "a frame of a past epoch is ignored";
    EXPECT_TRUE(faulty(frame(delta(2), 2, v1::ECO), "before a keyframe"));
    EXPECT_EQ(check_.received().ignored, 1U);
}

TEST_F(ChainCheckTest, RequiresFactsAndOrderBeforeFrames) {
    greet();
    EXPECT_TRUE(faulty(frame(keyframe(1), 2), "before its facts"));
    EXPECT_TRUE(fine(facts(2)));
    EXPECT_TRUE(faulty(frame(keyframe(1), 2), "before that order"));
    EXPECT_TRUE(faulty(facts(1), "epoch 1 after 2"));
    EXPECT_TRUE(faulty(order(2, {"\1\0\0\1\0\0", 6}), "no permutation"));
    EXPECT_TRUE(faulty(order(2, "abc"), "3 bytes for 2 spheres"));
}

TEST_F(ChainCheckTest, RejectsWrongHashesAndDecreasingSequences) {
    greet();
    std::string hashed = keyframe(5);
    const std::uint32_t flags = head | keyframeFlag | hashFlag, hash = 12345;
    std::memcpy(hashed.data(), &flags, 4);
    std::memcpy(&hashed[12], &hash, 4);
    EXPECT_TRUE(faulty(frame(hashed), "another hash"));
    sequence_ = 0;
    EXPECT_TRUE(faulty(frame(keyframe(6)), "sequence 1 after 1"));
    EXPECT_TRUE(faulty(frame("nonsense"), "8 bytes of 16"));
}

TEST_F(ChainCheckTest, RequiresExactlyOneWelcome) {
    EXPECT_TRUE(faulty(stream(), "before the welcome"));
    v1::ServerMessage welcome;
    welcome.mutable_welcome();
    EXPECT_TRUE(fine(welcome));
    EXPECT_TRUE(faulty(welcome, "a second welcome"));
}

}  // namespace
}  // namespace spherule::load
