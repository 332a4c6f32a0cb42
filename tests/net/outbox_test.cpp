#include "net/outbox.h"

#include "owner.h"

namespace spherule::net {
namespace {

using enum codec::EncodedFrame::Kind;

void describe(Outbox& outbox, std::uint32_t epoch) {
    ASSERT_TRUE(outbox.push(factsOf(epoch, 64)));
    ASSERT_TRUE(outbox.next(true)->content().has_scene());
    ASSERT_TRUE(outbox.push(orderOf(epoch)));
    ASSERT_TRUE(outbox.next(true)->content().has_order());
}

// That follows a chain, and knows its scene.
Outbox following(std::size_t capacity = 4) {
    Outbox outbox(capacity);
    outbox.follow({v1::NORMAL, 60});
    describe(outbox, 1);
    return outbox;
}

codec::EncodedFrame encoded(codec::EncodedFrame::Kind kind, std::uint32_t number, std::uint32_t epoch = 1) {
    return encodedFrame(kind, number, epoch, 64);
}

std::uint64_t nextFrame(Outbox& outbox) {
    const auto message = outbox.next(true);
    return message ? message->content().frame().sequence() : 0;
}

TEST(Outbox, SendsTheReliableLaneFirstAndInOrder) {
    Outbox outbox = following();
    const auto state = encoded(Keyframe, 1);
    const auto first = eventOf("first");
    const auto second = eventOf("second");
    outbox.offer(state);
    ASSERT_TRUE(outbox.push(first));
    ASSERT_TRUE(outbox.push(second));
    EXPECT_EQ(outbox.next(true), first);
    EXPECT_EQ(outbox.next(true), second);
    EXPECT_EQ(outbox.next(true), state.message);
    EXPECT_EQ(outbox.next(true), nullptr);
}

TEST(Outbox, IsFullAtItsCapacity) {
    Outbox outbox(2);
    EXPECT_TRUE(outbox.push(eventOf("1")));
    EXPECT_TRUE(outbox.push(eventOf("2")));
    EXPECT_FALSE(outbox.push(eventOf("3")));
}

TEST(Outbox, KeepsOnlyTheNewestFactsThatWait) {
    Outbox outbox(3);
    const auto event = eventOf("between");
    EXPECT_TRUE(outbox.push(factsOf(1, 64)));
    EXPECT_TRUE(outbox.push(event));
    for (std::uint32_t epoch = 2; epoch < 100; ++epoch) EXPECT_TRUE(outbox.push(factsOf(epoch, 64)));
    EXPECT_EQ(outbox.next(true), event);
    EXPECT_EQ(outbox.next(true)->content().scene().epoch(), 99U);
    EXPECT_EQ(outbox.next(true), nullptr);
}

TEST(Outbox, KeepsOnlyTheNewestDialAndDiagnosticsThatWait) {
    Outbox outbox(2);
    for (std::uint32_t substeps = 1; substeps < 100; ++substeps) {
        v1::ServerMessage dial;
        dial.mutable_dial()->add_positions()->set_substeps(substeps);
        v1::ServerMessage diagnostics;
        diagnostics.mutable_diagnostics()->set_substeps(substeps);
        EXPECT_TRUE(outbox.push(codec::share(std::move(dial))));
        EXPECT_TRUE(outbox.push(codec::share(std::move(diagnostics))));
    }
    EXPECT_EQ(outbox.next(true)->content().dial().positions(0).substeps(), 99U);
    EXPECT_EQ(outbox.next(true)->content().diagnostics().substeps(), 99U);
    EXPECT_EQ(outbox.next(true), nullptr);
}

TEST(Outbox, FollowsAChainFromItsKeyframeOn) {
    Outbox outbox = following();
    EXPECT_TRUE(outbox.wantsKeyframe());
    outbox.offer(encoded(Delta, 6));
    EXPECT_EQ(nextFrame(outbox), 0U) << "the one before is missing";
    EXPECT_EQ(outbox.offer(encoded(Resync, 6)), Outbox::Offered::Fine);
    EXPECT_FALSE(outbox.wantsKeyframe());
    EXPECT_EQ(nextFrame(outbox), 6U);
    EXPECT_EQ(outbox.offer(encoded(Resync, 6)), Outbox::Offered::Fine) << "for somebody else";
    EXPECT_EQ(nextFrame(outbox), 0U);
    EXPECT_EQ(outbox.offer(encoded(Delta, 7)), Outbox::Offered::Fine);
    EXPECT_EQ(nextFrame(outbox), 7U);
    EXPECT_EQ(outbox.offer(encoded(Keyframe, 8)), Outbox::Offered::Fine) << "the chain begins anew";
    EXPECT_EQ(nextFrame(outbox), 8U);
}

TEST(Outbox, LosesTheChainWhenAFrameCouldNotGoInTime) {
    Outbox outbox = following();
    EXPECT_EQ(outbox.offer(encoded(Keyframe, 1)), Outbox::Offered::Fine);
    EXPECT_EQ(outbox.offer(encoded(Delta, 2)), Outbox::Offered::Busy) << "1 still waits";
    EXPECT_TRUE(outbox.wantsKeyframe());
    EXPECT_EQ(nextFrame(outbox), 0U) << "it is old";
    EXPECT_EQ(outbox.offer(encoded(Delta, 3)), Outbox::Offered::Fine) << "lost already";
    EXPECT_EQ(nextFrame(outbox), 0U);
    EXPECT_EQ(outbox.offer(encoded(Resync, 3)), Outbox::Offered::Fine);
    EXPECT_EQ(nextFrame(outbox), 3U);
}

TEST(Outbox, LosesTheChainAtAGap) {
    Outbox outbox = following();
    outbox.offer(encoded(Keyframe, 1));
    EXPECT_EQ(nextFrame(outbox), 1U);
    EXPECT_EQ(outbox.offer(encoded(Delta, 3)), Outbox::Offered::Gap);
    EXPECT_TRUE(outbox.wantsKeyframe());
}

TEST(Outbox, HearsOfALossOnlyOnce) {
    Outbox outbox = following();
    EXPECT_EQ(outbox.offer(encoded(Keyframe, 4)), Outbox::Offered::Fine);
    EXPECT_FALSE(outbox.lose(3)) << "before the keyframe";
    EXPECT_EQ(nextFrame(outbox), 4U);
    EXPECT_TRUE(outbox.lose(4));
    EXPECT_TRUE(outbox.wantsKeyframe());
    outbox.follow({});
    EXPECT_FALSE(outbox.lose(5)) << "it follows none";
}

TEST(Outbox, TakesANewerKeyframeInPlaceOfOneThatWaits) {
    Outbox outbox = following();
    outbox.offer(encoded(Keyframe, 1));
    EXPECT_EQ(outbox.offer(encoded(Keyframe, 2)), Outbox::Offered::Fine);
    EXPECT_EQ(nextFrame(outbox), 2U);
    EXPECT_EQ(nextFrame(outbox), 0U);
}

TEST(Outbox, TakesNoFrameOfAnotherEpochForOneOfTheChain) {
    Outbox outbox = following();
    outbox.offer(encoded(Keyframe, 1));
    EXPECT_EQ(nextFrame(outbox), 1U);
    describe(outbox, 2);
    EXPECT_EQ(outbox.offer(encoded(Delta, 2, 2)), Outbox::Offered::Fine) << "nothing is lost that had begun";
    EXPECT_EQ(outbox.next(true), nullptr);
    EXPECT_TRUE(outbox.wantsKeyframe());
    EXPECT_EQ(outbox.offer(encoded(Keyframe, 1, 2)), Outbox::Offered::Fine);
    EXPECT_EQ(nextFrame(outbox), 1U) << "chains count from 1 in each epoch";
    describe(outbox, 3);
    EXPECT_EQ(outbox.offer(encoded(Keyframe, 1, 3)), Outbox::Offered::Fine);
    EXPECT_EQ(nextFrame(outbox), 1U);
}

TEST(Outbox, KnowsNothingOfOtherChains) {
    Outbox outbox = following();
    EXPECT_EQ(outbox.offer(encodedFrame(Keyframe, 1, 1, 64, {v1::ECO, 60})), Outbox::Offered::Fine);
    EXPECT_EQ(outbox.offer(encodedFrame(Keyframe, 1, 1, 64, {v1::NORMAL, 30})), Outbox::Offered::Fine);
    EXPECT_EQ(nextFrame(outbox), 0U);
    outbox.follow({v1::ECO, 60});
    EXPECT_EQ(outbox.offer(encoded(Keyframe, 2)), Outbox::Offered::Fine);
    EXPECT_EQ(nextFrame(outbox), 0U);
    outbox.follow({});
    EXPECT_FALSE(outbox.wantsKeyframe());
}

TEST(Outbox, HoldsFramesBackWhileTheClientHasNoCredit) {
    Outbox outbox = following();
    const auto event = eventOf("first");
    outbox.offer(encoded(Keyframe, 1));
    EXPECT_EQ(outbox.next(false), nullptr);
    ASSERT_TRUE(outbox.push(event));
    EXPECT_EQ(outbox.next(false), event);
    EXPECT_EQ(nextFrame(outbox), 1U);
}

TEST(Outbox, HoldsAFrameUntilTheFactsAndTheOrderOfItsEpochAreSent) {
    Outbox outbox = following();
    outbox.offer(encoded(Keyframe, 1, 2));
    EXPECT_EQ(outbox.next(true), nullptr);
    ASSERT_TRUE(outbox.push(factsOf(2, 64)));
    EXPECT_TRUE(outbox.next(true)->content().has_scene());
    EXPECT_EQ(outbox.next(true), nullptr) << "the order of the scene before does not count";
    ASSERT_TRUE(outbox.push(orderOf(2)));
    EXPECT_TRUE(outbox.next(true)->content().has_order());
    EXPECT_EQ(outbox.next(true)->content().frame().epoch(), 2U);
}

}  // namespace
}  // namespace spherule::net
