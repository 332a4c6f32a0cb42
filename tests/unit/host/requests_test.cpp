#include "host/requests.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace spherule::host {
namespace {

using namespace std::chrono_literals;

Request pauseOf(std::uint64_t session, std::uint64_t id, std::size_t bytes = 100) {
    Request request;
    request.session = session;
    request.bytes = bytes;
    request.command.set_id(id);
    request.command.mutable_pause();
    return request;
}

Request queryOf(std::uint64_t session, std::uint64_t id) {
    Request request;
    request.session = session;
    request.command.set_id(id);
    request.command.mutable_query();
    return request;
}

std::string popAll(Requests& requests) {
    std::string order;
    while (const auto request = requests.tryPop())
        order += std::to_string(request->session) + ":" + std::to_string(request->command.id()) + " ";
    return order;
}

TEST(Requests, AreTakenInOrderAndFromSessionsInTurn) {
    Requests requests;
    for (std::uint64_t id = 1; id <= 4; ++id) EXPECT_FALSE(requests.push(pauseOf(7, id)));
    EXPECT_FALSE(requests.push(pauseOf(3, 1)));
    EXPECT_FALSE(requests.push(pauseOf(9, 1)));
    EXPECT_FALSE(requests.push(pauseOf(9, 2)));
    EXPECT_EQ(popAll(requests), "3:1 7:1 9:1 7:2 9:2 7:3 7:4 ");
}

// The pull of a session that has ended must end after all its commands.
TEST(Requests, ReleaseComesAfterThePullsOfASession) {
    Requests requests({.commands = 10, .commandsPerSession = 2});
    requests.release(4);
    EXPECT_EQ(popAll(requests), "") << "it has pulled nothing";
    for (std::uint64_t id = 1; id <= 2; ++id) {
        Request pull = pauseOf(4, id);
        pull.command.mutable_pull()->set_sphere(3);
        EXPECT_FALSE(requests.push(std::move(pull)));
    }
    requests.release(4);
    requests.release(4);
    for (int k = 0; k < 2; ++k) EXPECT_TRUE(requests.tryPop()->answered);
    const auto release = requests.tryPop();
    ASSERT_TRUE(release);
    EXPECT_TRUE(release->command.has_release());
    EXPECT_EQ(release->session, 4U);
    EXPECT_FALSE(release->answered);
    EXPECT_FALSE(requests.tryPop());
}

TEST(Requests, AreLimitedPerSessionAndInTotal) {
    Requests requests({.commands = 10, .commandsPerSession = 4});
    for (std::uint64_t id = 1; id <= 4; ++id) EXPECT_FALSE(requests.push(pauseOf(1, id)));
    const auto reason = requests.push(pauseOf(1, 5));
    ASSERT_TRUE(reason);
    EXPECT_NE(reason->find("of this client"), std::string::npos) << *reason;
    for (std::uint64_t id = 1; id <= 4; ++id) EXPECT_FALSE(requests.push(pauseOf(2, id)));
    EXPECT_FALSE(requests.push(pauseOf(3, 1)));
    EXPECT_FALSE(requests.push(pauseOf(4, 1)));
    EXPECT_EQ(requests.push(pauseOf(5, 1)), "the command queue is full");
    EXPECT_TRUE(requests.tryPop());
    EXPECT_FALSE(requests.push(pauseOf(5, 1)));
}

TEST(Requests, AreLimitedByMemory) {
    Requests requests({.bytes = 1000, .bytesPerSession = 600});
    EXPECT_FALSE(requests.push(pauseOf(1, 1, 500)));
    EXPECT_TRUE(requests.refuses(1, 101)) << "of this session";
    EXPECT_TRUE(requests.push(pauseOf(1, 2, 101)));
    EXPECT_FALSE(requests.refuses(1, 100));
    EXPECT_FALSE(requests.push(pauseOf(2, 1, 500)));
    EXPECT_EQ(requests.refuses(3, 1), "the command queue is full");
    EXPECT_EQ(popAll(requests), "1:1 2:1 ");
    EXPECT_FALSE(requests.push(pauseOf(1, 2, 600))) << "what was taken counts no longer";
}

TEST(Requests, QueriesDoNotCountAsCommands) {
    const Requests::Limits limits;
    Requests requests;
    for (std::uint64_t viewer = 1; viewer <= 40; ++viewer) {
        for (std::uint64_t id = 1; id <= limits.queriesPerSession; ++id)
            EXPECT_FALSE(requests.push(queryOf(viewer, id)));
        EXPECT_TRUE(requests.push(queryOf(viewer, 99)));
    }
    for (std::uint64_t id = 1; id <= limits.commandsPerSession; ++id) EXPECT_FALSE(requests.push(pauseOf(41, id)));
    EXPECT_EQ(requests.tryPop()->session, 41U) << "no query comes before";
    EXPECT_EQ(requests.takeQueries().size(), 40 * limits.queriesPerSession);
    EXPECT_TRUE(requests.takeQueries().empty());
    EXPECT_FALSE(requests.push(queryOf(1, 100))) << "what was taken counts no longer";
}

TEST(Requests, WakeAWaitingThread) {
    Requests requests;
    EXPECT_FALSE(requests.popFor(1ms));
    std::jthread sender([&] { EXPECT_FALSE(requests.push(queryOf(1, 1))); });
    EXPECT_FALSE(requests.popFor(1h)) << "there is a query, and no command";
    EXPECT_EQ(requests.takeQueries().size(), 1U);
    sender = std::jthread([&] { EXPECT_FALSE(requests.push(pauseOf(1, 2))); });
    EXPECT_EQ(requests.popFor(1h)->command.id(), 2U);
}

}  // namespace
}  // namespace spherule::host
