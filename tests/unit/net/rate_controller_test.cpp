// Tests of RateController, AckWindow and renditions.
#include "net/rate_controller.h"

#include <gtest/gtest.h>

#include "net/ack_window.h"

namespace spherule::net {
namespace {

using namespace std::chrono_literals;
const RateController::Clock::time_point start = RateController::Clock::now();

RateController wanting(const codec::Rendition& rendition, bool fixed = false) {
    RateController controller(start);
    controller.setTarget(rendition, fixed, start);
    return controller;
}

// Reports losses at intervals of 0.1 s until the controller steps down; returns false if it does not.
bool stepsDown(RateController& controller, RateController::Clock::time_point& now) {
    for (int k = 0; k < 10; ++k)
        if (controller.onLoss(now += 100ms)) return true;
    return false;
}

TEST(RateController, ReducesRateBeforePrecision) {
    RateController controller = wanting({v1::NORMAL, 30});
    auto now = start;
    std::vector<codec::Rendition> down;
    while (stepsDown(controller, now)) down.push_back(controller.rendition());
    EXPECT_EQ(down, (std::vector<codec::Rendition>{{v1::NORMAL, 20}, {v1::NORMAL, 10}, {v1::ECO, 10}, {v1::ECO, 5}}));
    EXPECT_TRUE(controller.reduced());
}

TEST(RateController, ToleratesRareLosses) {
    RateController controller = wanting({v1::NORMAL, 30});
    for (int k = 0; k < 20; ++k) EXPECT_FALSE(controller.onLoss(start + k * 2s));
    EXPECT_FALSE(controller.reduced());
}

TEST(RateController, StepsUpInReverseOrderAfterAQuietTime) {
    RateController controller = wanting({v1::FINE, 10});
    auto now = start;
    ASSERT_TRUE(stepsDown(controller, now));
    ASSERT_TRUE(stepsDown(controller, now));
    EXPECT_EQ(controller.rendition(), (codec::Rendition{v1::ECO, 10}));
    EXPECT_FALSE(controller.onAck(60, 1, now + 9s));
    EXPECT_TRUE(controller.onAck(60, 1, now + 11s));
    EXPECT_EQ(controller.rendition(), (codec::Rendition{v1::NORMAL, 10}));
    EXPECT_TRUE(controller.onAck(60, 1, now + 22s));
    EXPECT_FALSE(controller.reduced());
    EXPECT_FALSE(controller.onAck(60, 1, now + 100s)) << "the target is reached";
}

TEST(RateController, WaitsLongerAfterAFailedStepUp) {
    RateController controller = wanting({v1::NORMAL, 30});
    auto now = start;
    ASSERT_TRUE(stepsDown(controller, now));
    ASSERT_TRUE(stepsDown(controller, now));
    ASSERT_TRUE(controller.onAck(60, 1, now += 11s));
    ASSERT_TRUE(stepsDown(controller, now));
    EXPECT_FALSE(controller.onAck(60, 1, now + 15s));
    EXPECT_TRUE(controller.onAck(60, 1, now + 21s));
}

TEST(RateController, ReducesRateForSlowDrawing) {
    RateController controller = wanting({v1::NORMAL, 30});
    int acks = 1;
    while (!controller.onAck(4, 1, start + acks * 33ms) && acks < 100) ++acks;
    EXPECT_EQ(acks, 30);
    EXPECT_EQ(controller.rendition(), (codec::Rendition{v1::NORMAL, 20}));
    RateController unknown = wanting({v1::NORMAL, 30});
    for (int k = 0; k < 100; ++k) EXPECT_FALSE(unknown.onAck(0, 1, start + k * 33ms));
}

TEST(RateController, WaitsLongerForSlowDrawing) {
    RateController controller = wanting({v1::NORMAL, 60});
    auto now = start;
    const auto slowly = [&](std::chrono::seconds time) {
        int changes = 0;
        for (const auto end = now + time; now < end; now += 33ms) changes += controller.onAck(20, 1, now) ? 1 : 0;
        return changes;
    };
    EXPECT_EQ(slowly(5s), 1);
    EXPECT_EQ(controller.rendition().rate, 30U);
    EXPECT_EQ(slowly(11s), 2) << "up, and down again";
    EXPECT_EQ(slowly(15s), 0);
}

TEST(RateController, ReducesRateForSlowDecoding) {
    RateController controller = wanting({v1::NORMAL, 30});
    std::optional<std::string> reason;
    for (int k = 0; k < 100 && !reason; ++k) reason = controller.onAck(60, 25, start + k * 33ms);
    EXPECT_EQ(reason, "a frame takes 25 ms to decode");
    EXPECT_EQ(controller.rendition().rate, 20U);
}

TEST(RateController, StepsUpWithoutAcks) {
    RateController controller = wanting({v1::NORMAL, 30});
    auto now = start;
    ASSERT_TRUE(stepsDown(controller, now));
    EXPECT_FALSE(controller.onTick(now + 9s));
    EXPECT_TRUE(controller.onTick(now + 11s));
    EXPECT_FALSE(controller.reduced());
}

TEST(RateController, KeepsTheContentOfFrames) {
    const codec::Rendition target{v1::FINE, 60, true, true, v1::SPEED};
    RateController controller = wanting(target);
    auto now = start;
    while (stepsDown(controller, now)) {
        codec::Rendition expected = target;
        expected.tier = controller.rendition().tier;
        expected.rate = controller.rendition().rate;
        EXPECT_EQ(controller.rendition(), expected);
    }
    EXPECT_EQ(controller.rendition().tier, v1::ECO);
    EXPECT_EQ(controller.rendition().rate, 5U);
}

TEST(RateController, KeepsAFixedRendition) {
    RateController controller = wanting({v1::FINE, 60}, true);
    auto now = start;
    EXPECT_FALSE(stepsDown(controller, now));
    EXPECT_EQ(controller.rendition(), (codec::Rendition{v1::FINE, 60}));
}

TEST(Rendition, RateIsTheNextLowerOne) {
    EXPECT_EQ(codec::rateFor(0), 0U);
    EXPECT_EQ(codec::rateFor(1), 5U);
    EXPECT_EQ(codec::rateFor(29), 20U);
    EXPECT_EQ(codec::rateFor(30), 30U);
    EXPECT_EQ(codec::rateFor(1000), 60U);
}

TEST(Rendition, QuantumIsTwiceTheError) {
    EXPECT_DOUBLE_EQ(codec::quantumOf(v1::FINE, 0.05), 2 * 0.05 / 500);
    EXPECT_DOUBLE_EQ(codec::quantumOf(v1::NORMAL, 0.05), 2 * 0.05 / 50);
    EXPECT_DOUBLE_EQ(codec::quantumOf(v1::ECO, 0.05), 2 * 0.05 / 16);
}

TEST(AckWindow, IsAQuarterOfASecondOfFrames) {
    AckWindow window;
    window.setRate(60);
    window.sent(1, start);
    window.acked(1);
    for (std::uint64_t sequence = 2; sequence < 17; ++sequence) {
        EXPECT_TRUE(window.open(start));
        window.sent(sequence, start);
    }
    EXPECT_FALSE(window.open(start));
    EXPECT_TRUE(window.open(start + 1s)) << "missing acks close the window only for a time";
    window.acked(9);
    EXPECT_TRUE(window.open(start));
    EXPECT_FALSE(window.idle(start));
    EXPECT_TRUE(window.idle(start + 1s));
}

TEST(AckWindow, IsUnlimitedWithoutAcks) {
    AckWindow window;
    window.setRate(30);
    for (std::uint64_t sequence = 1; sequence < 1000; ++sequence) window.sent(sequence, start);
    EXPECT_TRUE(window.open(start));
}

}  // namespace
}  // namespace spherule::net
