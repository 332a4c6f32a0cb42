#include "net/session_timeouts.h"

#include <gtest/gtest.h>

#include "net/server.h"

namespace spherule::net {
namespace {

using namespace std::chrono_literals;
using Verdict = SessionTimeouts::Verdict;

const SessionTimeouts::Clock::time_point start = SessionTimeouts::Clock::now();
const SessionTimeouts::Limits limits{.hello = 10s, .progress = 10s, .idle = 60s};

TEST(SessionTimeouts, DefaultsAreTenAndSixtySeconds) {
    EXPECT_EQ(Options{}.progressTimeout, 10s);
    EXPECT_EQ(Options{}.idleTimeout, 60s);
    EXPECT_EQ(Options{}.maxMessageBytes, 1024U * 1024U);
}

TEST(SessionTimeouts, RequiresHelloInTime) {
    SessionTimeouts timeouts(limits, start);
    EXPECT_EQ(timeouts.check({}, start + 9s), Verdict::Fine);
    EXPECT_EQ(timeouts.check({}, start + 11s), Verdict::NoHello);
    timeouts.helloReceived();
    EXPECT_EQ(timeouts.check({}, start + 11s), Verdict::Fine);
}

TEST(SessionTimeouts, PingsAtHalfTheIdleTimeAndThenDrops) {
    SessionTimeouts timeouts(limits, start);
    timeouts.helloReceived();
    EXPECT_EQ(timeouts.check({}, start + 31s), Verdict::Ping);
    EXPECT_EQ(timeouts.check({}, start + 32s), Verdict::Fine);
    EXPECT_EQ(timeouts.check({.acknowledged = 2}, start + 33s), Verdict::Fine);
    EXPECT_EQ(timeouts.check({.acknowledged = 2}, start + 61s), Verdict::Silent)
        << "the kernel's confirmation of the ping does not count";
}

TEST(SessionTimeouts, RestartsWhenDataArrives) {
    SessionTimeouts timeouts(limits, start);
    timeouts.helloReceived();
    EXPECT_EQ(timeouts.check({}, start + 31s), Verdict::Ping);
    EXPECT_EQ(timeouts.check({.received = 6}, start + 40s), Verdict::Fine);
    EXPECT_EQ(timeouts.check({.received = 6}, start + 69s), Verdict::Fine);
    EXPECT_EQ(timeouts.check({.received = 6}, start + 71s), Verdict::Ping);
}

TEST(SessionTimeouts, DropsAWriteWithoutProgress) {
    SessionTimeouts timeouts(limits, start);
    timeouts.helloReceived();
    timeouts.writeBegan(start + 1s);
    EXPECT_EQ(timeouts.check({.acknowledged = 1000}, start + 5s), Verdict::Fine);
    EXPECT_EQ(timeouts.check({.acknowledged = 1000}, start + 14s), Verdict::Fine);
    EXPECT_EQ(timeouts.check({.acknowledged = 1000}, start + 16s), Verdict::Stalled);
}

TEST(SessionTimeouts, AllowsASlowWriteWithProgress) {
    SessionTimeouts timeouts(limits, start);
    timeouts.helloReceived();
    timeouts.writeBegan(start);
    for (int i = 1; i < 40; ++i) {
        EXPECT_EQ(timeouts.check({.acknowledged = static_cast<std::uint64_t>(i)}, start + i * 5s), Verdict::Fine);
    }
}

TEST(SessionTimeouts, BoundsTheClosingHandshake) {
    SessionTimeouts timeouts(limits, start);
    timeouts.closeBegan(start + 100s);
    EXPECT_EQ(timeouts.check({}, start + 109s), Verdict::Fine);
    EXPECT_EQ(timeouts.check({.received = 9}, start + 111s), Verdict::Stalled);
}

}  // namespace
}  // namespace spherule::net
