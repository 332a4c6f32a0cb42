// What a client is sent while it keeps up, and while it does not.
#include "net/pace.h"

#include <gtest/gtest.h>

#include "net/credit.h"

namespace spherule::net {
namespace {

using namespace std::chrono_literals;
const Pace::Clock::time_point start = Pace::Clock::now();

Pace wanting(const codec::Rendition& rendition, bool fixed = false) {
    Pace pace(start);
    pace.want(rendition, fixed, start);
    return pace;
}

// Loses frames, a tenth of a second apart, until it steps down; false where it does not.
bool stepsDown(Pace& pace, Pace::Clock::time_point& now) {
    for (int k = 0; k < 10; ++k)
        if (pace.lost(now += 100ms)) return true;
    return false;
}

TEST(Pace, StepsDownInRateFirstThenInPrecision) {
    Pace pace = wanting({v1::NORMAL, 30});
    auto now = start;
    std::vector<codec::Rendition> down;
    while (stepsDown(pace, now)) down.push_back(pace.rendition());
    EXPECT_EQ(down, (std::vector<codec::Rendition>{{v1::NORMAL, 20}, {v1::NORMAL, 10}, {v1::ECO, 10}, {v1::ECO, 5}}));
    EXPECT_TRUE(pace.reduced());
}

TEST(Pace, BearsALossNowAndThen) {
    Pace pace = wanting({v1::NORMAL, 30});
    for (int k = 0; k < 20; ++k) EXPECT_FALSE(pace.lost(start + k * 2s));
    EXPECT_FALSE(pace.reduced());
}

TEST(Pace, StepsUpAfterAQuietTimeTheWayItCameDown) {
    Pace pace = wanting({v1::FINE, 10});
    auto now = start;
    ASSERT_TRUE(stepsDown(pace, now));
    ASSERT_TRUE(stepsDown(pace, now));
    EXPECT_EQ(pace.rendition(), (codec::Rendition{v1::ECO, 10}));
    EXPECT_FALSE(pace.acked(60, 1, now + 9s));
    EXPECT_TRUE(pace.acked(60, 1, now + 11s));
    EXPECT_EQ(pace.rendition(), (codec::Rendition{v1::NORMAL, 10}));
    EXPECT_TRUE(pace.acked(60, 1, now + 22s));
    EXPECT_FALSE(pace.reduced());
    EXPECT_FALSE(pace.acked(60, 1, now + 100s)) << "that is what was wanted";
}

TEST(Pace, WaitsLongerAfterAStepUpThatWasTooMuch) {
    Pace pace = wanting({v1::NORMAL, 30});
    auto now = start;
    ASSERT_TRUE(stepsDown(pace, now));
    ASSERT_TRUE(stepsDown(pace, now));
    ASSERT_TRUE(pace.acked(60, 1, now += 11s));
    ASSERT_TRUE(stepsDown(pace, now));
    EXPECT_FALSE(pace.acked(60, 1, now + 15s));
    EXPECT_TRUE(pace.acked(60, 1, now + 21s));
}

TEST(Pace, LowersTheRateForWhoDrawsSlowly) {
    Pace pace = wanting({v1::NORMAL, 30});
    int acks = 1;
    while (!pace.acked(4, 1, start + acks * 33ms) && acks < 100) ++acks;
    EXPECT_EQ(acks, 30);
    EXPECT_EQ(pace.rendition(), (codec::Rendition{v1::NORMAL, 20}));
    Pace unknown = wanting({v1::NORMAL, 30});
    for (int k = 0; k < 100; ++k) EXPECT_FALSE(unknown.acked(0, 1, start + k * 33ms));
}

TEST(Pace, WaitsLongerWithAStepUpForWhoDrawsSlowly) {
    Pace pace = wanting({v1::NORMAL, 60});
    auto now = start;
    const auto slowly = [&](std::chrono::seconds time) {
        int changes = 0;
        for (const auto end = now + time; now < end; now += 33ms) changes += pace.acked(20, 1, now) ? 1 : 0;
        return changes;
    };
    EXPECT_EQ(slowly(5s), 1);
    EXPECT_EQ(pace.rendition().rate, 30U);
    EXPECT_EQ(slowly(11s), 2) << "up, and down again";
    EXPECT_EQ(slowly(15s), 0);
}

TEST(Pace, LowersTheRateForWhoDecodesSlowly) {
    Pace pace = wanting({v1::NORMAL, 30});
    std::optional<std::string> reason;
    for (int k = 0; k < 100 && !reason; ++k) reason = pace.acked(60, 25, start + k * 33ms);
    EXPECT_EQ(reason, "a frame takes 25 ms to decode");
    EXPECT_EQ(pace.rendition().rate, 20U);
}

TEST(Pace, StepsUpWithoutAcksToo) {
    Pace pace = wanting({v1::NORMAL, 30});
    auto now = start;
    ASSERT_TRUE(stepsDown(pace, now));
    EXPECT_FALSE(pace.passed(now + 9s));
    EXPECT_TRUE(pace.passed(now + 11s));
    EXPECT_FALSE(pace.reduced());
}

TEST(Pace, LeavesWhatIsFixed) {
    Pace pace = wanting({v1::FINE, 60}, true);
    auto now = start;
    EXPECT_FALSE(stepsDown(pace, now));
    EXPECT_EQ(pace.rendition(), (codec::Rendition{v1::FINE, 60}));
}

TEST(Rendition, RatesAreTheNextOneBelow) {
    EXPECT_EQ(codec::rateFor(0), 0U);
    EXPECT_EQ(codec::rateFor(1), 5U);
    EXPECT_EQ(codec::rateFor(29), 20U);
    EXPECT_EQ(codec::rateFor(30), 30U);
    EXPECT_EQ(codec::rateFor(1000), 60U);
}

TEST(Rendition, QuantaAreTwiceTheErrors) {
    EXPECT_DOUBLE_EQ(codec::quantumOf(v1::FINE, 0.05), 2 * 0.05 / 500);
    EXPECT_DOUBLE_EQ(codec::quantumOf(v1::NORMAL, 0.05), 2 * 0.05 / 50);
    EXPECT_DOUBLE_EQ(codec::quantumOf(v1::ECO, 0.05), 2 * 0.05 / 16);
}

TEST(Credit, EndsWithAQuarterOfASecondOfFramesOnTheirWay) {
    Credit credit;
    credit.setRate(60);
    credit.sent(1, start);
    credit.acked(1);
    for (std::uint64_t sequence = 2; sequence < 17; ++sequence) {
        EXPECT_TRUE(credit.open(start));
        credit.sent(sequence, start);
    }
    EXPECT_FALSE(credit.open(start));
    EXPECT_TRUE(credit.open(start + 1s)) << "acks that are missing do not end it for good";
    credit.acked(9);
    EXPECT_TRUE(credit.open(start));
    EXPECT_FALSE(credit.idle(start));
    EXPECT_TRUE(credit.idle(start + 1s));
}

TEST(Credit, IsWithoutEndForWhoNeverSays) {
    Credit credit;
    credit.setRate(30);
    for (std::uint64_t sequence = 1; sequence < 1000; ++sequence) credit.sent(sequence, start);
    EXPECT_TRUE(credit.open(start));
}

}  // namespace
}  // namespace spherule::net
