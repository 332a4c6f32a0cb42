#include "net/send_queue.h"

#include "fake_app.h"

namespace spherule::net {
namespace {

using enum codec::EncodedFrame::Kind;

void describe(SendQueue& queue, std::uint32_t epoch) {
    ASSERT_TRUE(queue.push(factsOf(epoch, 64)));
    ASSERT_TRUE(queue.next(true)->content().has_scene());
    ASSERT_TRUE(queue.push(orderOf(epoch)));
    ASSERT_TRUE(queue.next(true)->content().has_order());
}

// A queue that follows a rendition and has sent its facts and order.
SendQueue following(std::size_t capacity = 4) {
    SendQueue queue(capacity);
    queue.follow({v1::NORMAL, 60});
    describe(queue, 1);
    return queue;
}

codec::EncodedFrame encoded(codec::EncodedFrame::Kind kind, std::uint32_t number, std::uint32_t epoch = 1) {
    return encodedFrame(kind, number, epoch, 64);
}

std::uint64_t nextFrame(SendQueue& queue) {
    const auto message = queue.next(true);
    return message ? message->content().frame().sequence() : 0;
}

TEST(SendQueue, SendsTheReliableLaneFirstAndInOrder) {
    SendQueue queue = following();
    const auto state = encoded(Keyframe, 1);
    const auto first = eventOf("first");
    const auto second = eventOf("second");
    queue.offer(state);
    ASSERT_TRUE(queue.push(first));
    ASSERT_TRUE(queue.push(second));
    EXPECT_EQ(queue.next(true), first);
    EXPECT_EQ(queue.next(true), second);
    EXPECT_EQ(queue.next(true), state.message);
    EXPECT_EQ(queue.next(true), nullptr);
}

TEST(SendQueue, IsFullAtItsCapacity) {
    SendQueue queue(2);
    EXPECT_TRUE(queue.push(eventOf("1")));
    EXPECT_TRUE(queue.push(eventOf("2")));
    EXPECT_FALSE(queue.push(eventOf("3")));
}

TEST(SendQueue, ReplacesQueuedFacts) {
    SendQueue queue(3);
    const auto event = eventOf("between");
    EXPECT_TRUE(queue.push(factsOf(1, 64)));
    EXPECT_TRUE(queue.push(event));
    for (std::uint32_t epoch = 2; epoch < 100; ++epoch) EXPECT_TRUE(queue.push(factsOf(epoch, 64)));
    EXPECT_EQ(queue.next(true), event);
    EXPECT_EQ(queue.next(true)->content().scene().epoch(), 99U);
    EXPECT_EQ(queue.next(true), nullptr);
}

TEST(SendQueue, ReplacesQueuedDialAndDiagnostics) {
    SendQueue queue(2);
    for (std::uint32_t substeps = 1; substeps < 100; ++substeps) {
        v1::ServerMessage dial;
        dial.mutable_dial()->add_positions()->set_substeps(substeps);
        v1::ServerMessage diagnostics;
        diagnostics.mutable_diagnostics()->set_substeps(substeps);
        EXPECT_TRUE(queue.push(codec::share(std::move(dial))));
        EXPECT_TRUE(queue.push(codec::share(std::move(diagnostics))));
    }
    EXPECT_EQ(queue.next(true)->content().dial().positions(0).substeps(), 99U);
    EXPECT_EQ(queue.next(true)->content().diagnostics().substeps(), 99U);
    EXPECT_EQ(queue.next(true), nullptr);
}

TEST(SendQueue, StartsAChainAtAKeyframe) {
    SendQueue queue = following();
    EXPECT_TRUE(queue.wantsKeyframe());
    queue.offer(encoded(Delta, 6));
    EXPECT_EQ(nextFrame(queue), 0U) << "the previous frame is missing";
    EXPECT_EQ(queue.offer(encoded(Resync, 6)), SendQueue::OfferResult::Accepted);
    EXPECT_FALSE(queue.wantsKeyframe());
    EXPECT_EQ(nextFrame(queue), 6U);
    EXPECT_EQ(queue.offer(encoded(Resync, 6)), SendQueue::OfferResult::Accepted) << "a resync for other sessions";
    EXPECT_EQ(nextFrame(queue), 0U);
    EXPECT_EQ(queue.offer(encoded(Delta, 7)), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(nextFrame(queue), 7U);
    EXPECT_EQ(queue.offer(encoded(Keyframe, 8)), SendQueue::OfferResult::Accepted) << "the chain restarts";
    EXPECT_EQ(nextFrame(queue), 8U);
}

TEST(SendQueue, LosesTheChainWhenTheFrameSlotIsBusy) {
    SendQueue queue = following();
    EXPECT_EQ(queue.offer(encoded(Keyframe, 1)), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(queue.offer(encoded(Delta, 2)), SendQueue::OfferResult::Busy) << "frame 1 is still queued";
    EXPECT_TRUE(queue.wantsKeyframe());
    EXPECT_EQ(nextFrame(queue), 0U) << "the frame is stale";
    EXPECT_EQ(queue.offer(encoded(Delta, 3)), SendQueue::OfferResult::Accepted) << "lost already";
    EXPECT_EQ(nextFrame(queue), 0U);
    EXPECT_EQ(queue.offer(encoded(Resync, 3)), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(nextFrame(queue), 3U);
}

TEST(SendQueue, LosesTheChainAtAGap) {
    SendQueue queue = following();
    queue.offer(encoded(Keyframe, 1));
    EXPECT_EQ(nextFrame(queue), 1U);
    EXPECT_EQ(queue.offer(encoded(Delta, 3)), SendQueue::OfferResult::Gap);
    EXPECT_TRUE(queue.wantsKeyframe());
}

TEST(SendQueue, ReportsALossOnce) {
    SendQueue queue = following();
    EXPECT_EQ(queue.offer(encoded(Keyframe, 4)), SendQueue::OfferResult::Accepted);
    EXPECT_FALSE(queue.reportLoss(3)) << "before the keyframe";
    EXPECT_EQ(nextFrame(queue), 4U);
    EXPECT_TRUE(queue.reportLoss(4));
    EXPECT_TRUE(queue.wantsKeyframe());
    queue.follow({});
    EXPECT_FALSE(queue.reportLoss(5)) << "it follows no rendition";
}

TEST(SendQueue, ReplacesAQueuedKeyframe) {
    SendQueue queue = following();
    queue.offer(encoded(Keyframe, 1));
    EXPECT_EQ(queue.offer(encoded(Keyframe, 2)), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(nextFrame(queue), 2U);
    EXPECT_EQ(nextFrame(queue), 0U);
}

TEST(SendQueue, RejectsFramesOfAnotherEpoch) {
    SendQueue queue = following();
    queue.offer(encoded(Keyframe, 1));
    EXPECT_EQ(nextFrame(queue), 1U);
    describe(queue, 2);
    EXPECT_EQ(queue.offer(encoded(Delta, 2, 2)), SendQueue::OfferResult::Accepted) << "no chain had started";
    EXPECT_EQ(queue.next(true), nullptr);
    EXPECT_TRUE(queue.wantsKeyframe());
    EXPECT_EQ(queue.offer(encoded(Keyframe, 1, 2)), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(nextFrame(queue), 1U) << "chains count from 1 in each epoch";
    describe(queue, 3);
    EXPECT_EQ(queue.offer(encoded(Keyframe, 1, 3)), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(nextFrame(queue), 1U);
}

TEST(SendQueue, IgnoresOtherRenditions) {
    SendQueue queue = following();
    EXPECT_EQ(queue.offer(encodedFrame(Keyframe, 1, 1, 64, {v1::ECO, 60})), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(queue.offer(encodedFrame(Keyframe, 1, 1, 64, {v1::NORMAL, 30})), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(nextFrame(queue), 0U);
    queue.follow({v1::ECO, 60});
    EXPECT_EQ(queue.offer(encoded(Keyframe, 2)), SendQueue::OfferResult::Accepted);
    EXPECT_EQ(nextFrame(queue), 0U);
    queue.follow({});
    EXPECT_FALSE(queue.wantsKeyframe());
}

TEST(SendQueue, HoldsFramesWhileTheAckWindowIsClosed) {
    SendQueue queue = following();
    const auto event = eventOf("first");
    queue.offer(encoded(Keyframe, 1));
    EXPECT_EQ(queue.next(false), nullptr);
    ASSERT_TRUE(queue.push(event));
    EXPECT_EQ(queue.next(false), event);
    EXPECT_EQ(nextFrame(queue), 1U);
}

TEST(SendQueue, HoldsAFrameUntilItsFactsAndOrderAreSent) {
    SendQueue queue = following();
    queue.offer(encoded(Keyframe, 1, 2));
    EXPECT_EQ(queue.next(true), nullptr);
    ASSERT_TRUE(queue.push(factsOf(2, 64)));
    EXPECT_TRUE(queue.next(true)->content().has_scene());
    EXPECT_EQ(queue.next(true), nullptr) << "the order belongs to the previous scene";
    ASSERT_TRUE(queue.push(orderOf(2)));
    EXPECT_TRUE(queue.next(true)->content().has_order());
    EXPECT_EQ(queue.next(true)->content().frame().epoch(), 2U);
}

codec::SharedMessage changeOf(std::uint32_t number) {
    v1::ServerMessage message;
    message.mutable_population()->set_epoch(1);
    message.mutable_population()->set_number(number);
    return codec::share(std::move(message));
}

codec::SharedMessage factsWith(std::uint32_t population) {
    v1::ServerMessage message = factsOf(1, 64)->content();
    message.mutable_scene()->set_population(population);
    return codec::share(std::move(message));
}

codec::EncodedFrame frameOf(std::uint32_t number, std::uint32_t population) {
    codec::EncodedFrame frame = encoded(Keyframe, number);
    v1::ServerMessage message = frame.message->content();
    message.mutable_frame()->set_population(population);
    frame.message = codec::share(std::move(message));
    return frame;
}

TEST(SendQueue, HoldsAFrameUntilItsChangeOfThePopulationIsSent) {
    SendQueue queue = following();
    queue.offer(frameOf(1, 1));
    EXPECT_EQ(queue.next(true), nullptr);
    ASSERT_TRUE(queue.push(changeOf(1)));
    EXPECT_TRUE(queue.next(true)->content().has_population());
    EXPECT_TRUE(queue.next(true)->content().has_frame());
}

TEST(SendQueue, AsksForFactsWhenTooManyChangesWait) {
    SendQueue queue = following(100);
    std::uint32_t number = 0;
    while (!queue.takeMissedChanges()) {
        ASSERT_TRUE(queue.push(changeOf(++number)));
        ASSERT_LT(number, 100U);
    }
    ASSERT_TRUE(queue.push(changeOf(number + 1)));
    EXPECT_EQ(queue.next(true), nullptr) << "no change is sent after a missing one";
    queue.offer(frameOf(1, number + 1));
    ASSERT_TRUE(queue.push(factsWith(number)));
    EXPECT_TRUE(queue.next(true)->content().has_scene());
    EXPECT_EQ(queue.next(true), nullptr) << "the frame needs one change more";
    ASSERT_TRUE(queue.push(changeOf(number + 1)));
    EXPECT_TRUE(queue.next(true)->content().has_population());
    EXPECT_TRUE(queue.next(true)->content().has_frame()) << "the order is still known";
    EXPECT_FALSE(queue.takeMissedChanges());
}

}  // namespace
}  // namespace spherule::net
