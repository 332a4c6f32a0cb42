#include "fake_app.h"
#include "raw_socket.h"

namespace spherule::net {
namespace {

const std::string viewers = "viewers-token-of-a-test";
const std::string controllers = "controllers-token-of-a-test";

class Tokens : public testing::Test {
  protected:
    static Options options() {
        Options options = quickOptions();
        options.credentials.viewerToken = viewers;
        options.credentials.controllerToken = controllers;
        options.guessDelay = 300ms;
        options.allowedNames.hosts = {"spherule.example.org"};
        return options;
    }

    std::unique_ptr<Client> joinAs(const std::string& token) {
        auto client = connect(app_);
        v1::ClientMessage hello = helloOf(0);
        hello.mutable_hello()->set_token(token);
        EXPECT_TRUE(client->send(hello));
        welcome_ = next(*client).welcome();
        return client;
    }

    // Reads the result of a command and skips other messages.
    static v1::CommandResult give(Client& client, const v1::Command& command) {
        v1::ClientMessage message;
        *message.mutable_command() = command;
        EXPECT_TRUE(client.send(message));
        for (;;) {
            const auto answer = next(client);
            if (answer.has_result() || answer.kind_case() == v1::ServerMessage::KIND_NOT_SET) return answer.result();
        }
    }

    static v1::Command pause() {
        v1::Command command;
        command.set_id(7);
        command.mutable_pause();
        return command;
    }

    std::uint64_t rejected(RejectReason cause) { return app_.counters().rejectedFor(cause); }

    std::string ask(const std::string& head) {
        const RawSocket socket(app_.server().port());
        socket.send(head + "Connection: close\r\n\r\n");
        return socket.readAll();
    }

    static std::string upgrade(const std::string& host, const std::string& more) {
        return "GET /ws HTTP/1.1\r\nHost: " + host +
               "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
               "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: spherule.v1\r\n" +
               more + "\r\n";
    }

    std::string open(const std::string& host, const std::string& more) {
        const RawSocket socket(app_.server().port());
        socket.send(upgrade(host, more));
        return socket.readUntil("\r\n\r\n").substr(9, 3);
    }

    FakeApp app_{options()};
    v1::Welcome welcome_;
};

TEST_F(Tokens, RejectsMissingToken) {
    const auto client = connect(app_);
    ASSERT_TRUE(client->send(helloOf(60)));
    const auto end = readToEnd(*client);
    EXPECT_EQ(end.code, 4401);
    EXPECT_EQ(end.reason, "this server asks for a token");
    EXPECT_EQ(rejected(RejectReason::NoToken), 1U);
    EXPECT_TRUE(eventually([&] { return app_.counters().closedBy(CloseCause::NoToken) == 1; }));
}

TEST_F(Tokens, DelaysAndCountsWrongTokens) {
    const auto began = std::chrono::steady_clock::now();
    const auto client = connect(app_);
    v1::ClientMessage hello = helloOf(60);
    hello.mutable_hello()->set_token("controllers-token-of-a-tesT");
    ASSERT_TRUE(client->send(hello));
    v1::ClientMessage command;
    *command.mutable_command() = pause();
    ASSERT_TRUE(client->send(command));
    app_.publish(64);
    const auto received = client->receive(patience);
    ASSERT_FALSE(received) << "a protected stream was sent";
    EXPECT_EQ(client->closed()->code, 4401);
    EXPECT_EQ(client->closed()->reason, "this token is not known here");
    EXPECT_GE(std::chrono::steady_clock::now() - began, options().guessDelay);
    EXPECT_EQ(rejected(RejectReason::WrongToken), 1U);
    EXPECT_TRUE(app_.commands().empty());
}

TEST_F(Tokens, LetsViewersWatchOnly) {
    const auto client = joinAs(viewers);
    EXPECT_EQ(welcome_.role(), v1::VIEWER);
    const auto result = give(*client, pause());
    EXPECT_EQ(result.id(), 7U);
    EXPECT_NE(result.refused().reason().find("a viewer may not command"), std::string::npos);
    v1::Command query;
    query.set_id(8);
    query.mutable_query();
    EXPECT_TRUE(give(*client, query).has_applied());
    ASSERT_EQ(app_.commands().size(), 1U);
    EXPECT_TRUE(app_.commands()[0].has_query());
    EXPECT_EQ(rejected(RejectReason::ViewersCommand), 1U);
}

TEST_F(Tokens, GivesControlToOneSessionAtATime) {
    const auto first = joinAs(controllers);
    EXPECT_EQ(welcome_.role(), v1::CONTROLLER);
    const std::uint64_t holder = welcome_.session();
    const auto second = joinAs(controllers);
    EXPECT_TRUE(give(*first, pause()).has_applied());
    EXPECT_NE(give(*second, pause()).refused().reason().find("session " + std::to_string(holder)), std::string::npos);
    EXPECT_EQ(rejected(RejectReason::ControlHeld), 1U);
    first->close();
    EXPECT_TRUE(eventually([&] { return give(*second, pause()).has_applied(); }));
}

TEST_F(Tokens, LimitsMessagesOfViewers) {
    const auto client = joinAs(viewers);
    ASSERT_TRUE(client->sendBytes(std::string(Options().firstMessageBytes + 1, '\0'), Encoding::Binary));
    EXPECT_EQ(readToEnd(*client).code, 1009);
}

TEST_F(Tokens, LimitsTheFirstMessage) {
    const auto client = connect(app_);
    ASSERT_TRUE(client->sendBytes(std::string(Options().firstMessageBytes + 1, '\0'), Encoding::Binary));
    EXPECT_EQ(readToEnd(*client).code, 1009);
}

TEST_F(Tokens, LimitsTheCommandRate) {
    const auto client = joinAs(controllers);
    bool refused = false;
    for (int k = 0; k < 300 && !refused; ++k) {
        const auto result = give(*client, pause());
        refused = result.refused().reason().find("too many commands") != std::string::npos;
        EXPECT_TRUE(result.has_applied() || refused);
    }
    EXPECT_TRUE(refused);
    EXPECT_GE(rejected(RejectReason::CommandRate), 1U);
}

TEST_F(Tokens, RefusesForeignOrigins) {
    EXPECT_EQ(open("localhost", "Origin: http://evil.example\r\n"), "403");
    EXPECT_EQ(open("localhost", "Origin: null\r\n"), "403");
    EXPECT_EQ(rejected(RejectReason::Origin), 2U);
    EXPECT_EQ(open("localhost", "Origin: http://localhost\r\n"), "101");
    EXPECT_EQ(open("localhost", ""), "101") << "not a browser";
}

TEST_F(Tokens, RefusesForeignHostNames) {
    EXPECT_EQ(open("evil.example", "Origin: http://evil.example\r\n"), "421");
    EXPECT_EQ(ask("GET /healthz HTTP/1.1\r\nHost: evil.example\r\n").substr(9, 3), "421");
    EXPECT_EQ(ask("GET /healthz HTTP/1.1\r\n").substr(9, 3), "421");
    EXPECT_EQ(rejected(RejectReason::Host), 3U);
    EXPECT_EQ(ask("GET /healthz HTTP/1.1\r\nHost: spherule.example.org\r\n").substr(9, 3), "200");
}

TEST_F(Tokens, RequiresTokenForMetrics) {
    const std::string request = "GET /metrics HTTP/1.1\r\nHost: localhost\r\n";
    const auto answer = ask(request);
    EXPECT_EQ(answer.substr(9, 3), "401");
    EXPECT_NE(answer.find("WWW-Authenticate: Bearer"), std::string::npos);
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(ask(request + "Authorization: Bearer nonsense\r\n").substr(9, 3), "401");
    EXPECT_GE(std::chrono::steady_clock::now() - began, options().guessDelay);
    EXPECT_EQ(ask(request + "Authorization: Bearer " + viewers + "\r\n").substr(9, 3), "404") << "admitted";
    EXPECT_EQ(ask("GET /metrics?token=" + viewers + " HTTP/1.1\r\nHost: localhost\r\n").substr(9, 3), "401");
}

TEST_F(Tokens, RequiresTokenForDownloads) {
    const std::string request = "GET /recordings/one.sph HTTP/1.1\r\nHost: localhost\r\n";
    EXPECT_EQ(ask(request).substr(9, 3), "401");
    EXPECT_EQ(ask(request + "Authorization: Bearer nonsense\r\n").substr(9, 3), "401");
    EXPECT_EQ(ask(request + "Authorization: Bearer " + viewers + "\r\n").substr(9, 3), "200");
    EXPECT_EQ(ask("GET /recordings/one.sph?token=" + viewers + " HTTP/1.1\r\nHost: localhost\r\n").substr(9, 3), "401");
}

TEST_F(Tokens, RequiresTokenForTheScene) {
    const std::string request = "GET /scene.json HTTP/1.1\r\nHost: localhost\r\n";
    EXPECT_EQ(ask(request).substr(9, 3), "401");
    EXPECT_EQ(ask(request + "Authorization: Bearer " + viewers + "\r\n").substr(9, 3), "200");
}

TEST_F(Tokens, AppliesNewTokensToNewSessions) {
    const auto before = joinAs(viewers);
    Credentials credentials = options().credentials;
    credentials.viewerToken = "the-viewers-new-token";
    ASSERT_TRUE(app_.server().setCredentials(credentials));
    const auto late = connect(app_);
    v1::ClientMessage hello = helloOf(0);
    hello.mutable_hello()->set_token(viewers);
    ASSERT_TRUE(late->send(hello));
    EXPECT_EQ(readToEnd(*late).code, 4401);
    joinAs("the-viewers-new-token");
    EXPECT_EQ(welcome_.role(), v1::VIEWER);
    EXPECT_FALSE(app_.server().setCredentials({})) << "a server with tokens never runs without them";
}

TEST(Exposure, RefusesPublicAddressWithoutTokens) {
    Options options = quickOptions();
    options.host = "0.0.0.0";
    const auto refused = startServer(options, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Input);
    EXPECT_NE(refused.error().text().find("--open"), std::string::npos);
    options.open = true;
    EXPECT_NO_THROW(FakeApp{options});
}

// The application ends the pull of a session that may not command any more.
TEST(Exposure, ReportsTheLossOfControlAndTheEndOfASession) {
    Options options = quickOptions();
    options.open = true;
    FakeApp app(options);
    auto first = join(app, 0);
    auto second = join(app, 0);
    v1::ClientMessage message;
    message.mutable_ask_control();
    ASSERT_TRUE(first->send(message));
    ASSERT_TRUE(eventually([&] { return next(*first).has_control(); }));
    ASSERT_TRUE(second->send(message));
    while (next(*first).control().asking_size() == 0) {
    }
    EXPECT_TRUE(app.silenced().empty());
    message.mutable_yield_control();
    ASSERT_TRUE(first->send(message));
    EXPECT_TRUE(eventually([&] { return app.silenced() == std::vector<SessionId>{1}; }));
    second.reset();
    EXPECT_TRUE(eventually([&] { return app.silenced().size() >= 2; }));
    EXPECT_EQ(app.silenced()[1], 2U);
}

TEST(Exposure, LimitsSessions) {
    Options options = quickOptions();
    options.connectionLimits.sessions = 2;
    FakeApp app(options);
    const auto first = join(app, 0);
    {
        const auto second = join(app, 0);
        const auto third = connect(app);
        ASSERT_TRUE(third->send(helloOf(0)));
        const auto end = readToEnd(*third);
        EXPECT_EQ(end.code, 1013);
        EXPECT_EQ(end.reason, "the limit of open sessions is reached");
    }
    EXPECT_EQ(app.counters().rejectedFor(RejectReason::Sessions), 1U);
    EXPECT_TRUE(eventually([&] { return app.counters().sessions == 1; }));
    join(app, 0);
}

TEST(Exposure, LimitsConnectionRate) {
    Options options = quickOptions();
    options.connectionLimits.connectionsPerSecond = 5;
    FakeApp app(options);
    int answered = 0;
    for (int k = 0; k < 12; ++k) {
        const RawSocket socket(app.server().port());
        socket.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
        if (!socket.readAll().empty()) ++answered;
    }
    EXPECT_GE(answered, 5);
    EXPECT_LT(answered, 12);
    EXPECT_EQ(app.counters().rejectedFor(RejectReason::ConnectionRate), 12U - static_cast<unsigned>(answered));
}

TEST(Exposure, RefusesProxyNamesWithoutTokens) {
    Options options = quickOptions();
    options.allowedNames.origins = {"https://spherule.example.org"};
    EXPECT_FALSE(startServer(options, {}));
}

TEST(Exposure, BoundsBufferOfEndlessRequest) {
    FakeApp app;
    for (const std::string& endless : {"5;" + std::string(1'000'000, 'a'), "0\r\nX: " + std::string(1'000'000, 'a')}) {
        const RawSocket socket(app.server().port());
        socket.send("GET / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n" + endless);
        EXPECT_EQ(socket.readAll().substr(0, 12), "HTTP/1.1 431");
    }
}

TEST(Exposure, ClosesUnfinishedRequests) {
    Options options = quickOptions();
    options.requestTimeout = 200ms;
    FakeApp app(options);
    const RawSocket socket(app.server().port());
    socket.send("GET / HTTP/1.1\r\nHost: loc");
    EXPECT_EQ(socket.readAll(), "");
    EXPECT_TRUE(eventually([&] { return app.counters().rejectedFor(RejectReason::SlowRequest) == 1; }));
}

}  // namespace
}  // namespace spherule::net
