#include "encode/stream_encoder.h"
#include "encode/morton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "core/memory.h"

namespace spherule::encode {
namespace {

using namespace std::chrono_literals;
using Kind = codec::EncodedFrame::Kind;
constexpr codec::Rendition normal{v1::NORMAL, 30};

// StreamEncoder for a world of spheres on the CPU device.
class StreamEncoderTest : public testing::Test {
  protected:
    static constexpr std::uint32_t spheres = 100;

    StreamEncoderTest()
        : encoder_(
              *device_, [this](const codec::EncodedFrame& encoded) { encoded_.push_back(encoded); },
              [this](auto order) { orders_.push_back(std::move(order)); },
              [this](const std::string& text) { warnings_.push_back(text); }, framesMade_) {
        position_ = std::move(*device_->createBuffer("positions", spheres * sizeof(glm::vec4), "r"));
        positions_.resize(spheres);
    }

    [[nodiscard]] EncoderInput encoderInput() const {
        return {.source = {.columns = {position_.get()}, .slotOf = nullptr},
                .spheres = count_,
                .smallestRadius = 0.05,
                .epoch = epoch_,
                .version = version_,
                .order =
                    [this] {
                        const std::vector<std::uint32_t> ids = mortonOrder(positions_);
                        return CodecOrder{.ids = ids, .handles = ids};
                    },
                .head = [] { return v1::Frame(); }};
    }

    // Serves the subscriptions after `steps` more steps; returns the kinds of the frames.
    std::string serve(std::vector<codec::Subscription> subscriptions, std::chrono::milliseconds later,
                      std::uint64_t steps = 1) {
        version_ += steps;
        now_ += later;
        encoded_.clear();
        encoder_.update(encoderInput(), subscriptions, now_);
        std::string kinds;
        for (const codec::EncodedFrame& encoded : encoded_)
            kinds += encoded.kind == Kind::Keyframe ? 'K' : encoded.kind == Kind::Resync ? 'J' : 'D';
        return kinds;
    }

    std::unique_ptr<compute::Device> device_ = std::move(*compute::openDevice("cpu:1"));
    std::unique_ptr<compute::Buffer> position_;
    std::vector<glm::vec4> positions_;
    std::vector<codec::EncodedFrame> encoded_;
    std::vector<codec::SharedMessage> orders_;
    std::vector<std::string> warnings_;
    std::uint64_t framesMade_ = 0;
    StreamEncoder encoder_;
    std::uint32_t count_ = spheres;
    std::uint32_t epoch_ = 1;
    std::uint64_t version_ = 0;
    StreamEncoder::Clock::time_point now_ = StreamEncoder::Clock::now();
};

TEST_F(StreamEncoderTest, EncodesNothingWithoutViewersAndAKeyframeForTheFirst) {
    EXPECT_EQ(serve({}, 1s), "");
    EXPECT_TRUE(orders_.empty());
    EXPECT_EQ(serve({{.rendition = normal, .newcomer = true}}, 1s), "K");
    ASSERT_EQ(orders_.size(), 1U);
    EXPECT_EQ(orders_[0]->content().order().ids().size(), 3 * spheres);
    EXPECT_EQ(encoded_[0].message->content().frame().order(), orders_[0]->content().order().number());
    EXPECT_EQ(encoded_[0].number, 1U);
    EXPECT_EQ(serve({{.rendition = normal}}, 40ms), "D");
    EXPECT_EQ(encoded_[0].number, 2U);
}

TEST_F(StreamEncoderTest, EncodesEachChainAtItsRate) {
    const codec::Rendition slow{v1::ECO, 10};
    serve({{.rendition = normal}, {.rendition = slow}}, 1s);
    std::size_t fast = 0;
    std::size_t slowly = 0;
    for (int k = 0; k < 1000; ++k) {
        serve({{.rendition = normal}, {.rendition = slow}}, 2ms);
        for (const codec::EncodedFrame& encoded : encoded_) ++(encoded.rendition == slow ? slowly : fast);
    }
    EXPECT_NEAR(static_cast<double>(fast), 60, 2);
    EXPECT_NEAR(static_cast<double>(slowly), 20, 1);
}

TEST_F(StreamEncoderTest, EncodesOnlyKeyframesForNewViewersWhilePaused) {
    serve({{.rendition = normal, .newcomer = true}}, 1s);
    EXPECT_EQ(serve({{.rendition = normal}}, 1s, 0), "");
    EXPECT_FALSE(encoder_.due());
    EXPECT_EQ(serve({{.rendition = normal, .newcomer = true}}, 1s, 0), "J");
    EXPECT_EQ(encoded_[0].number, 1U) << "of the state that others have";
}

TEST_F(StreamEncoderTest, ServesNewAndLostViewersWhenStepsAreSlowerThanFrames) {
    serve({{.rendition = normal, .newcomer = true}}, 1s);
    for (const codec::Subscription& subscription :
         {codec::Subscription{normal, true, false}, codec::Subscription{normal, false, true}}) {
        std::string kinds;
        for (int k = 0; k < 6; ++k) kinds += serve({subscription}, 200ms);
        EXPECT_NE(kinds.find('J'), std::string::npos) << kinds;
        EXPECT_NE(kinds.find('D'), std::string::npos) << kinds << ": all others go on";
    }
}

TEST_F(StreamEncoderTest, LimitsTheRateOfKeyframesForLostViewers) {
    serve({{.rendition = normal}}, 1s);
    int joins = 0;
    for (int k = 0; k < 200; ++k) {
        const std::string kinds = serve({{.rendition = normal, .lost = true}}, 5ms);
        joins += static_cast<int>(std::ranges::count(kinds, 'J'));
    }
    EXPECT_GE(joins, 3);
    EXPECT_LE(joins, 4) << "one in 250 ms";
}

TEST_F(StreamEncoderTest, SendsKeyframesForNewSpheresAndReturningViewers) {
    serve({{.rendition = normal}}, 1s);
    epoch_ = 2;
    EXPECT_EQ(serve({{.rendition = normal}}, 40ms), "K");
    EXPECT_EQ(orders_.size(), 2U);
    serve({}, 40ms);
    EXPECT_EQ(serve({{.rendition = normal, .newcomer = true}}, 40ms), "K");
    EXPECT_EQ(orders_.size(), 2U) << "the spheres are the same";
    count_ = 0;
    epoch_ = 3;
    EXPECT_EQ(serve({{.rendition = normal}}, 40ms), "");
}

TEST_F(StreamEncoderTest, WarnsWhenMemoryIsInsufficientForFrames) {
    const std::uint64_t before = memory::claimed().held;
    count_ = 200'000;
    memory::setLimit(1);
    EXPECT_EQ(serve({{.rendition = normal, .newcomer = true}}, 1s), "");
    EXPECT_EQ(serve({{.rendition = normal, .newcomer = true}}, 1s), "");
    const Result<void> refused = encoder_.open(normal, encoderInput());
    memory::setLimit(0);
    ASSERT_EQ(warnings_.size(), 1U) << "not again and again";
    EXPECT_NE(warnings_[0].find("Viewers of NORMAL at 30/s get no frames: "), std::string::npos) << warnings_[0];
    EXPECT_NE(warnings_[0].find("MiB more of memory are needed"), std::string::npos) << warnings_[0];
    EXPECT_TRUE(orders_.empty());
    EXPECT_EQ(memory::claimed().held, before);
    ASSERT_FALSE(refused) << "a recording would be refused";
    EXPECT_EQ(refused.error().kind, ErrorKind::Refused);
    count_ = spheres;
    EXPECT_EQ(serve({{.rendition = normal, .newcomer = true}}, 11s), "K") << "tried again";
    EXPECT_GT(memory::claimed().held, before);
}

}  // namespace
}  // namespace spherule::encode
