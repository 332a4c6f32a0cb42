#include "net/connection_limiter.h"

#include <gtest/gtest.h>

namespace spherule::net {
namespace {

using namespace std::chrono_literals;
using boost::asio::ip::make_address;

TEST(TokenBucket, PassesAverageRate) {
    auto now = TokenBucket::Clock::time_point();
    TokenBucket bucket(10, now);
    int taken = 0;
    for (int k = 0; k < 1000; ++k, now += 10ms) taken += bucket.take(now) ? 1 : 0;
    EXPECT_NEAR(taken, 110, 1) << "10/s for 10 s, plus the burst of one second";
}

TEST(TokenBucket, WithRateZeroHasNoLimit) {
    TokenBucket bucket(0, {});
    for (int k = 0; k < 1000; ++k) EXPECT_TRUE(bucket.take({}));
}

TEST(ConnectionLimiter, CountsAnIPv6NetworkAsOneAddress) {
    const auto limiter = std::make_shared<ConnectionLimiter>(ConnectionLimits{.sessions = 0, .sessionsPerAddress = 2});
    const auto now = ConnectionLimiter::Clock::now();
    const auto come = [&](const char* from) {
        EXPECT_FALSE(limiter->refuses(make_address(from), now));
        return limiter->admit(make_address(from));
    };
    const auto first = come("2001:db8::1");
    const auto second = come("2001:db8::2");
    const auto third = come("2001:db8::3");
    const auto other = come("2001:db8:0:1::1");
    EXPECT_FALSE(first->openSession());
    EXPECT_FALSE(second->openSession());
    EXPECT_EQ(third->openSession(), RejectReason::SessionsPerAddress);
    EXPECT_FALSE(other->openSession());
    const auto mapped = come("::ffff:10.0.0.1");
    const auto same = come("10.0.0.1");
    EXPECT_EQ(limiter->known(), 3U);
}

TEST(ConnectionLimiter, RemovesIdleAddresses) {
    const auto limiter = std::make_shared<ConnectionLimiter>(ConnectionLimits{});
    auto now = ConnectionLimiter::Clock::now();
    for (unsigned k = 0; k < 100'000; ++k, now += 1ms) {
        const boost::asio::ip::address_v4 from(0x0a000000U + k);
        if (!limiter->refuses(from, now)) limiter->admit(from);
    }
    EXPECT_LT(limiter->known(), 10'000U);
}

TEST(ConnectionLimiter, LimitsConnectionsThatAreNoSessions) {
    const auto limiter = std::make_shared<ConnectionLimiter>(
        ConnectionLimits{.sessions = 10, .sessionsPerAddress = 0, .connectionsPerSecond = 0});
    EXPECT_FALSE(limiter->refuses(make_address("10.0.0.2"), {}));
    const auto session = limiter->admit(make_address("10.0.0.2"));
    EXPECT_FALSE(session->openSession());
    std::vector<std::unique_ptr<ConnectionLimiter::Permit>> inside;
    const auto from = make_address("10.0.0.1");
    while (!limiter->refuses(from, {})) inside.push_back(limiter->admit(from));
    EXPECT_EQ(inside.size(), 256U) << "sessions are counted separately";
    inside.pop_back();
    EXPECT_FALSE(limiter->refuses(from, {}));
}

}  // namespace
}  // namespace spherule::net
