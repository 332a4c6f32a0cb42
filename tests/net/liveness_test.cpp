#include "net/liveness.h"

#include <gtest/gtest.h>

#include "net/server.h"

namespace spherule::net {
namespace {

using namespace std::chrono_literals;
using Verdict = Liveness::Verdict;

const Liveness::Clock::time_point start = Liveness::Clock::now();
const Liveness::Limits limits{.hello = 10s, .progress = 10s, .idle = 60s};

TEST(Liveness, IsTenSecondsForProgressAndSixtyForSilenceUnlessAskedOtherwise) {
    EXPECT_EQ(Options{}.progressTimeout, 10s);
    EXPECT_EQ(Options{}.idleTimeout, 60s);
    EXPECT_EQ(Options{}.maxMessageBytes, 1024U * 1024U);
}

TEST(Liveness, WantsAHelloInTime) {
    Liveness liveness(limits, start);
    EXPECT_EQ(liveness.check({}, start + 9s), Verdict::Fine);
    EXPECT_EQ(liveness.check({}, start + 11s), Verdict::NoHello);
    liveness.helloCame();
    EXPECT_EQ(liveness.check({}, start + 11s), Verdict::Fine);
}

TEST(Liveness, PingsOnceAtHalfTheIdleTimeAndGivesUpAtItsEnd) {
    Liveness liveness(limits, start);
    liveness.helloCame();
    EXPECT_EQ(liveness.check({}, start + 31s), Verdict::Ping);
    EXPECT_EQ(liveness.check({}, start + 32s), Verdict::Fine);
    EXPECT_EQ(liveness.check({.acknowledged = 2}, start + 33s), Verdict::Fine);
    EXPECT_EQ(liveness.check({.acknowledged = 2}, start + 61s), Verdict::Silent)
        << "that the kernel took the ping is no sign of life";
}

TEST(Liveness, StartsAnewWhenSomethingIsHeard) {
    Liveness liveness(limits, start);
    liveness.helloCame();
    EXPECT_EQ(liveness.check({}, start + 31s), Verdict::Ping);
    EXPECT_EQ(liveness.check({.received = 6}, start + 40s), Verdict::Fine);
    EXPECT_EQ(liveness.check({.received = 6}, start + 69s), Verdict::Fine);
    EXPECT_EQ(liveness.check({.received = 6}, start + 71s), Verdict::Ping);
}

TEST(Liveness, EndsAWriteWithoutProgress) {
    Liveness liveness(limits, start);
    liveness.helloCame();
    liveness.writeBegan(start + 1s);
    EXPECT_EQ(liveness.check({.acknowledged = 1000}, start + 5s), Verdict::Fine);
    EXPECT_EQ(liveness.check({.acknowledged = 1000}, start + 14s), Verdict::Fine);
    EXPECT_EQ(liveness.check({.acknowledged = 1000}, start + 16s), Verdict::Stalled);
}

TEST(Liveness, KeepsAWriteThatTakesLongButAdvances) {
    Liveness liveness(limits, start);
    liveness.helloCame();
    liveness.writeBegan(start);
    for (int i = 1; i < 40; ++i) {
        EXPECT_EQ(liveness.check({.acknowledged = static_cast<std::uint64_t>(i)}, start + i * 5s), Verdict::Fine);
    }
}

TEST(Liveness, BoundsTheClosingHandshake) {
    Liveness liveness(limits, start);
    liveness.closeBegan(start + 100s);
    EXPECT_EQ(liveness.check({}, start + 109s), Verdict::Fine);
    EXPECT_EQ(liveness.check({.received = 9}, start + 111s), Verdict::Stalled);
}

}  // namespace
}  // namespace spherule::net
