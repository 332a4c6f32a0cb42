#include <random>

#include "core/text.h"
#include "fake_app.h"
#include "net/sanitize.h"
#include "raw_socket.h"

namespace spherule::net {
namespace {

TEST(BadClients, WithoutSubprotocolAreRefused) {
    FakeApp app;
    for (const std::string asked : {"", "chat", "spherule.v2", "spherule.v10"}) {
        const auto client = Client::connect(app.url(), patience, asked);
        ASSERT_FALSE(client) << asked;
        EXPECT_NE(client.error().text().find("HTTP 400"), std::string::npos) << client.error().text();
        EXPECT_NE(client.error().text().find("must ask for subprotocol spherule.v1"), std::string::npos);
    }
    EXPECT_TRUE(Client::connect(app.url(), patience, "chat, spherule.v1"));
    EXPECT_EQ(app.counters().rejectedFor(RejectReason::Subprotocol), 4U);
}

TEST(BadClients, WithoutHelloAreClosed) {
    Options options = quickOptions();
    options.helloTimeout = 200ms;
    FakeApp app(options);
    const auto client = connect(app);
    const auto end = readToEnd(*client);
    EXPECT_EQ(end.code, 1008);
    EXPECT_EQ(end.reason, "no hello came in time");
    EXPECT_TRUE(eventually([&] { return app.counters().closedBy(CloseCause::NoHello) == 1; }));
}

TEST(BadClients, WithAnotherFirstMessageAreClosed) {
    FakeApp app;
    const auto client = connect(app);
    v1::ClientMessage message;
    message.mutable_command()->mutable_pause();
    ASSERT_TRUE(client->send(message));
    EXPECT_EQ(readToEnd(*client).code, 1008);
    EXPECT_TRUE(app.commands().empty());
}

TEST(BadClients, WithTwoHellosAreClosed) {
    FakeApp app;
    const auto client = join(app, 0);
    ASSERT_TRUE(client->send(helloOf(10)));
    EXPECT_EQ(readToEnd(*client).code, 1008);
}

TEST(BadClients, WithTooLongMessageAreClosedWith1009) {
    FakeApp app;
    const auto client = join(app, 0);
    ASSERT_TRUE(client->sendBytes(std::string(Options().maxMessageBytes + 1, '\0'), Encoding::Binary));
    EXPECT_EQ(readToEnd(*client).code, 1009);
    EXPECT_TRUE(eventually([&] { return app.counters().closedBy(CloseCause::TooBig) == 1; }));
}

TEST(BadClients, WithInvalidBytesAreClosedWith1007) {
    FakeApp app;
    const auto client = join(app, 0);
    ASSERT_TRUE(client->sendBytes("\xff\xff\xff", Encoding::Binary));
    const auto end = readToEnd(*client);
    EXPECT_EQ(end.code, 1007);
    EXPECT_EQ(end.reason, "not a ClientMessage of spherule.v1");
    EXPECT_TRUE(eventually([&] { return app.counters().closedBy(CloseCause::Undecodable) == 1; }));
}

TEST(BadClients, WithInvalidTextAreClosedWith1007) {
    FakeApp app;
    const std::string accented = R"({"command":{"pause":{}, ")" + std::string(200, '\xc3') + R"(": 1}})";
    for (const std::string text : {"rubbish", "{", "", R"({"command":{"id":1,"set":{"friction":nothing}}})"}) {
        const auto client = join(app, 0, Encoding::Text);
        ASSERT_TRUE(client->sendBytes(text, Encoding::Text));
        const auto end = readToEnd(*client);
        EXPECT_EQ(end.code, 1007) << text;
        EXPECT_NE(end.reason.find("not the JSON form"), std::string::npos) << text << ": " << end.reason;
    }
    const auto client = join(app, 0, Encoding::Text);
    ASSERT_TRUE(client->sendBytes(accented, Encoding::Text));
    EXPECT_EQ(readToEnd(*client).code, 1007) << "text that is not UTF-8";
}

TEST(BadClients, GetCloseReasonCutBetweenCharacters) {
    FakeApp app;
    for (const std::string before : {"", "a"}) {
        const auto client = connect(app);
        std::string name = before;
        for (int i = 0; i < 100; ++i) name += "ü";
        ASSERT_TRUE(client->sendBytes(R"({")" + name + R"(":1})", Encoding::Text));
        const auto end = readToEnd(*client);
        EXPECT_EQ(end.code, 1007) << end.reason;
        EXPECT_GT(end.reason.size(), 100U);
        EXPECT_EQ(end.reason, utf8(end.reason));
    }
}

// The parser's error quotes the text around a fault and may cut a character.
TEST(BadClients, GetCloseReasonInValidUtf8) {
    FakeApp app;
    for (int shift = 0; shift < 4; ++shift) {
        const auto client = join(app, 0, Encoding::Text);
        std::string name;
        for (int i = 0; i < 20; ++i) name += "ü";
        ASSERT_TRUE(client->sendBytes(R"({")" + name + std::string(static_cast<std::size_t>(shift), 'x') + R"("1})",
                                      Encoding::Text));
        const auto end = readToEnd(*client);
        EXPECT_EQ(end.code, 1007);
        EXPECT_EQ(end.reason, utf8(end.reason)) << "shift " << shift;
    }
    const std::string reason = closeReason("caf\xc3 and " + std::string(111, 'x') + "\xc3\xbc");
    EXPECT_EQ(reason, utf8(reason));
    EXPECT_EQ(reason.size(), 122U) << reason;
}

TEST(BadClients, FaultEndsOnlyItsSession) {
    FakeApp app;
    const auto other = join(app, 0);
    const auto client = join(app, 0);
    app.throws = true;
    v1::ClientMessage message;
    message.mutable_command()->mutable_pause();
    ASSERT_TRUE(client->send(message));
    EXPECT_EQ(readToEnd(*client).code, 1006) << "no close frame";
    const RawSocket socket(app.server().port());
    socket.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(socket.readAll(), "");
    app.throws = false;
    EXPECT_TRUE(eventually([&] { return app.counters().closedBy(CloseCause::Fault) == 1; }));
    EXPECT_TRUE(eventually([&] { return app.counters().rejectedFor(RejectReason::Fault) == 2; }));
    EXPECT_EQ(app.counters().sessions, 1U);
    ASSERT_TRUE(other->send(message));
    EXPECT_TRUE(next(*other).result().has_applied());
    EXPECT_TRUE(join(app, 0)) << "later clients are served";
}

TEST(BadClients, WithInvalidHttpAreAnsweredAndClosed) {
    FakeApp app;
    const auto healthy = join(app, 60);
    std::mt19937 random(1);
    for (int i = 0; i < 50; ++i) {
        std::string garbage(1 + random() % 500, '\0');
        for (char& c : garbage) c = static_cast<char>(random());
        const RawSocket socket(app.server().port());
        socket.send(garbage + "\r\n\r\n");
        EXPECT_EQ(socket.readAll().substr(0, 12), "HTTP/1.1 400");
    }
    app.publish(64);
    EXPECT_TRUE(next(*healthy).has_frame());
}

TEST(BadClients, WithInvalidFramesAreClosed) {
    FakeApp app;
    const auto healthy = join(app, 60);
    std::mt19937 random(2);
    for (int i = 0; i < 50; ++i) {
        const RawSocket socket(app.server().port());
        ASSERT_EQ(socket.openStream().substr(0, 12), "HTTP/1.1 101");
        std::string garbage(300, '\0');
        for (char& c : garbage) c = static_cast<char>(random());
        garbage[0] = static_cast<char>(0xf0);  // reserved bits without a meaning
        socket.send(garbage);
        const std::string answer = socket.readAll();
        ASSERT_GE(answer.size(), 4U);
        EXPECT_EQ(answer.substr(2, 2), "\x03\xea") << "a close frame with 1002";
    }
    EXPECT_TRUE(eventually([&] { return app.counters().closedBy(CloseCause::Protocol) == 50; }));
    app.publish(64);
    EXPECT_TRUE(next(*healthy).has_frame());
}

TEST(BadClients, CompressionIsDeclined) {
    FakeApp app;
    const RawSocket socket(app.server().port());
    socket.send(
        "GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Extensions: permessage-deflate\r\nSec-WebSocket-Protocol: spherule.v1\r\n\r\n");
    const std::string head = socket.readUntil("\r\n\r\n");
    EXPECT_EQ(head.substr(0, 12), "HTTP/1.1 101");
    EXPECT_EQ(head.find("deflate"), std::string::npos);
}

}  // namespace
}  // namespace spherule::net
