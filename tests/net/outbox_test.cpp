#include "net/outbox.h"

#include "owner.h"

namespace spherule::net {
namespace {

using Clock = Outbox::Clock;
const Clock::time_point start = Clock::now();

void describe(Outbox& outbox, std::uint32_t epoch) {
    ASSERT_TRUE(outbox.push(factsOf(epoch, 64)));
    ASSERT_TRUE(outbox.next(start)->content().has_scene());
}

TEST(Outbox, SendsTheReliableLaneFirstAndInOrder) {
    Outbox outbox(4, 60);
    describe(outbox, 1);
    const auto state = stateOf(1, 1, 64);
    const auto first = eventOf("first");
    const auto second = eventOf("second");
    outbox.offer(state, start);
    ASSERT_TRUE(outbox.push(first));
    ASSERT_TRUE(outbox.push(second));
    EXPECT_EQ(outbox.next(start), first);
    EXPECT_EQ(outbox.next(start), second);
    EXPECT_EQ(outbox.next(start), state);
    EXPECT_EQ(outbox.next(start), nullptr);
}

TEST(Outbox, IsFullAtItsCapacity) {
    Outbox outbox(2, 60);
    EXPECT_TRUE(outbox.push(eventOf("1")));
    EXPECT_TRUE(outbox.push(eventOf("2")));
    EXPECT_FALSE(outbox.push(eventOf("3")));
}

TEST(Outbox, KeepsOnlyTheNewestFactsThatWait) {
    Outbox outbox(3, 60);
    const auto event = eventOf("between");
    EXPECT_TRUE(outbox.push(factsOf(1, 64)));
    EXPECT_TRUE(outbox.push(event));
    for (std::uint32_t epoch = 2; epoch < 100; ++epoch) EXPECT_TRUE(outbox.push(factsOf(epoch, 64)));
    EXPECT_EQ(outbox.next(start), event);
    EXPECT_EQ(outbox.next(start)->content().scene().epoch(), 99U);
    EXPECT_EQ(outbox.next(start), nullptr);
}

TEST(Outbox, KeepsOnlyTheNewestDialAndDiagnosticsThatWait) {
    Outbox outbox(2, 60);
    for (std::uint32_t substeps = 1; substeps < 100; ++substeps) {
        v1::ServerMessage dial;
        dial.mutable_dial()->add_positions()->set_substeps(substeps);
        v1::ServerMessage diagnostics;
        diagnostics.mutable_diagnostics()->set_substeps(substeps);
        EXPECT_TRUE(outbox.push(frame::share(std::move(dial))));
        EXPECT_TRUE(outbox.push(frame::share(std::move(diagnostics))));
    }
    EXPECT_EQ(outbox.next(start)->content().dial().positions(0).substeps(), 99U);
    EXPECT_EQ(outbox.next(start)->content().diagnostics().substeps(), 99U);
    EXPECT_EQ(outbox.next(start), nullptr);
}

TEST(Outbox, KeepsTheNewestStateAndTellsOfTheOneThatItReplaced) {
    Outbox outbox(2, 60);
    describe(outbox, 1);
    EXPECT_FALSE(outbox.offer(stateOf(1, 1, 64), start));
    EXPECT_TRUE(outbox.offer(stateOf(2, 1, 64), start));
    EXPECT_EQ(outbox.next(start)->content().frame().sequence(), 2U);
}

TEST(Outbox, HoldsAStateBackUntilItsRateAllowsIt) {
    Outbox outbox(2, 10);
    describe(outbox, 1);
    outbox.offer(stateOf(1, 1, 64), start);
    EXPECT_NE(outbox.next(start), nullptr);
    EXPECT_FALSE(outbox.offer(stateOf(2, 1, 64), start + 10ms));
    EXPECT_FALSE(outbox.offer(stateOf(3, 1, 64), start + 20ms)) << "the rate skipped it";
    EXPECT_EQ(outbox.next(start + 20ms), nullptr);
    ASSERT_TRUE(outbox.frameDue());
    EXPECT_LE(*outbox.frameDue(), start + 100ms);
    EXPECT_EQ(outbox.next(*outbox.frameDue())->content().frame().sequence(), 3U);
}

TEST(Outbox, NeverSendsTheStateOfAnOldScene) {
    Outbox outbox(2, 60);
    describe(outbox, 1);
    outbox.offer(stateOf(1, 1, 64), start);
    describe(outbox, 2);
    EXPECT_EQ(outbox.next(start), nullptr);
    EXPECT_FALSE(outbox.frameDue());
}

TEST(Outbox, HoldsAStateUntilTheFactsOfItsEpochAreSent) {
    Outbox outbox(2, 60);
    outbox.offer(stateOf(1, 2, 64), start);
    EXPECT_EQ(outbox.next(start), nullptr);
    describe(outbox, 2);
    EXPECT_EQ(outbox.next(start)->content().frame().epoch(), 2U);
}

}  // namespace
}  // namespace spherule::net
