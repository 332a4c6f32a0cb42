#include <cmath>

#include "client/command_parser.h"
#include "client/ctl.h"
#include "fake_app.h"

namespace spherule::net {
namespace {

v1::ClientMessage pauseOf(std::uint64_t id) {
    v1::ClientMessage message;
    message.mutable_command()->set_id(id);
    message.mutable_command()->mutable_pause();
    return message;
}

TEST(Commands, ReachTheAppAndAnswerTheSender) {
    FakeApp app;
    const auto sender = join(app, 0);
    const auto other = join(app, 0);
    ASSERT_TRUE(sender->send(pauseOf(99)));
    const auto answer = next(*sender);
    EXPECT_EQ(answer.result().id(), 99U);
    EXPECT_EQ(answer.result().applied().step(), 7U);
    ASSERT_EQ(app.commands().size(), 1U);
    EXPECT_TRUE(app.commands()[0].has_pause());
    app.server().broadcast(eventOf("only this"));
    EXPECT_EQ(next(*other).event().text(), "only this");
}

TEST(Commands, MayBeText) {
    FakeApp app;
    const auto client = join(app, 0, Encoding::Text);
    ASSERT_TRUE(client->sendBytes(R"({"command":{"id":5,"set":{"gravity":[0,0,-1.6]}}})", Encoding::Text));
    EXPECT_EQ(next(*client).result().id(), 5U);
    ASSERT_EQ(app.commands().size(), 1U);
    EXPECT_EQ(app.commands()[0].set().gravity(2), -1.6);
}

TEST(Commands, AreRefusedWhenTheQueueIsFull) {
    FakeApp app;
    app.takesCommands = false;
    const auto client = join(app, 0);
    ASSERT_TRUE(client->send(pauseOf(3)));
    const auto answer = next(*client);
    EXPECT_EQ(answer.result().id(), 3U);
    EXPECT_EQ(answer.result().refused().reason(), "the command queue is full");
    EXPECT_EQ(answer.result().refused().cause(), v1::Refused::TOO_MANY_COMMANDS);
}

TEST(Commands, UnknownToTheServerAreRefused) {
    FakeApp app;
    const auto client = join(app, 0);
    // A ClientMessage whose command has id 4 and, in the unknown field 100, an empty message.
    const std::string_view unknown("\x12\x05\x08\x04\xa2\x06\x00", 7);
    ASSERT_TRUE(client->sendBytes(unknown, Encoding::Binary));
    const auto answer = next(*client);
    EXPECT_EQ(answer.result().id(), 4U);
    EXPECT_EQ(answer.result().refused().reason(), "the command is not known to this server");
    EXPECT_TRUE(app.commands().empty());
    ASSERT_TRUE(client->send(pauseOf(5)));
    EXPECT_EQ(next(*client).result().applied().step(), 7U);
}

TEST(Commands, InvalidOnesAreRefusedWithFieldAndReason) {
    FakeApp app;
    const auto client = join(app, 0, Encoding::Text);
    struct Case {
        std::string text, id, field, reason;
    };
    const std::vector<Case> cases = {
        {R"({"command":{"id":7,"set":{"gravty":[0,0,0]}}})", "7", "set.gravty", "is not a field of"},
        {R"({"command":{"set":{"max_speed":1},"id":"8"}})", "8", "set.maxSpeed", "is not a field of"},
        {R"({"command":{"id":9,"step":{"count":"many"}}})", "9", "step.count", "\"many\""},
        {R"({"command":{"id":9,"step":{"count":NaN}}})", "9", "step.count", "\"NaN\""},
        {R"({"command":{"id":9,"set":{"gravity":[0,1e999,0]}}})", "9", "set.gravity[1]", "\"1e999\""},
        {R"({"command":{"id":10,"set":[]}})", "10", "set", "not repeating"},
        {R"({"command":{"id":11,"pausee":{}}})", "11", "pausee", "is not a field of"},
        {R"({"command":{"id":12,"load":{"scene":{"groups":[{"radius":{"constan":1}}]}}}})", "12",
         "load.scene.groups[0].radius.constan", "is not a field of"},
        {R"({"comand":{"id":13,"pause":{}}})", "0", "comand", "is not a field of"},
        {R"({"command":{"id":"one","pause":{}}})", "0", "id", "\"one\""},
        {"[]", "0", "", "must be a message"},
    };
    for (const Case& one : cases) {
        ASSERT_TRUE(client->sendBytes(one.text, Encoding::Text));
        const v1::CommandResult result = next(*client).result();
        EXPECT_EQ(std::to_string(result.id()), one.id) << one.text;
        EXPECT_EQ(result.refused().field(), one.field) << one.text;
        EXPECT_EQ(result.refused().cause(), v1::Refused::UNFIT) << one.text;
        EXPECT_NE(result.refused().reason().find(one.reason), std::string::npos) << result.refused().reason();
    }
    EXPECT_EQ(app.counters().rejectedFor(RejectReason::UnfitCommand), cases.size());
    EXPECT_TRUE(app.commands().empty());
    ASSERT_TRUE(client->sendBytes(R"({"command":{"id":99,"pause":{}}})", Encoding::Text));
    EXPECT_EQ(next(*client).result().id(), 99U);
}

// NaN and Infinity as Python and JavaScript libraries write them. The application refuses them with the field.
TEST(Commands, OthersAreToldWithTheNameOfTheSender) {
    FakeApp app;
    const auto sender = join(app, 0);
    const auto other = join(app, 0);
    ASSERT_TRUE(sender->send(pauseOf(5)));
    EXPECT_EQ(next(*sender).result().id(), 5U);
    v1::Event event;
    event.set_kind(v1::Event::COMMANDED);
    app.server().announce(1, event);
    const v1::Event told = next(*other).event();
    EXPECT_EQ(told.kind(), v1::Event::COMMANDED);
    EXPECT_EQ(told.by().session(), 1U);
    EXPECT_EQ(told.by().client(), helloOf(0).hello().client());
    // The sender is not told: its next message is another.
    app.server().broadcast(eventOf("warm"));
    EXPECT_EQ(next(*sender).event().text(), "warm");
}

TEST(Commands, MayHaveNonFiniteNumbers) {
    FakeApp app;
    const auto client = join(app, 0, Encoding::Text);
    ASSERT_TRUE(client->sendBytes(R"({"command":{"id":1,"set":{"friction":NaN,"speed":-Infinity}}})", Encoding::Text));
    EXPECT_EQ(next(*client).result().id(), 1U);
    ASSERT_EQ(app.commands().size(), 1U);
    const v1::Command command = app.commands().front();
    EXPECT_TRUE(std::isnan(command.set().friction()));
    EXPECT_TRUE(std::isinf(command.set().speed()));
}

TEST(Commands, NeedingTooMuchMemoryAreRefused) {
    FakeApp app;
    for (const Encoding encoding : {Encoding::Binary, Encoding::Text}) {
        const auto client = join(app, 0, encoding);
        v1::ClientMessage message;
        message.mutable_command()->set_id(6);
        for (int k = 0; k < 300'000; ++k) message.mutable_command()->mutable_load()->mutable_scene()->add_groups();
        ASSERT_TRUE(client->send(message, encoding));
        const v1::CommandResult result = next(*client).result();
        EXPECT_EQ(result.id(), 6U);
        EXPECT_NE(result.refused().reason().find("more than 16 MiB"), std::string::npos) << result.refused().reason();
        ASSERT_TRUE(client->send(pauseOf(7), encoding));
        EXPECT_EQ(next(*client).result().applied().step(), 7U);
    }
    EXPECT_EQ(app.commands().size(), 2U);
    EXPECT_EQ(app.counters().rejectedFor(RejectReason::CommandCost), 2U);
}

TEST(Commands, LongOnesAreNotParsedWhenTheQueueIsFull) {
    FakeApp app;
    app.takesLong = false;
    const auto client = join(app, 0);
    v1::ClientMessage message;
    message.mutable_command()->set_id(8);
    message.mutable_command()->mutable_load()->mutable_scene()->set_description(std::string(10'000, 'x'));
    // If it were parsed, the session would end here.
    ASSERT_TRUE(client->sendBytes(message.SerializeAsString() + '\xff', Encoding::Binary));
    const v1::CommandResult result = next(*client).result();
    EXPECT_EQ(result.id(), 8U);
    EXPECT_EQ(result.refused().reason(), "the command queue is full");
    ASSERT_TRUE(client->send(pauseOf(9)));
    EXPECT_EQ(next(*client).result().id(), 9U);
}

TEST(Commands, MayHaveTheLargestSize) {
    FakeApp app;
    const auto client = join(app, 0);
    v1::ClientMessage message;
    message.mutable_command()->set_id(1);
    const std::size_t frame = 64;  // bytes for everything around the text, at most
    message.mutable_command()->mutable_load()->mutable_scene()->set_description(
        std::string(Options().maxMessageBytes - frame, 'x'));
    ASSERT_TRUE(client->send(message));
    EXPECT_TRUE(next(*client).result().has_applied());
}

TEST(Commands, OfAClosedSessionHaveNoAnswer) {
    FakeApp app;
    app.server().reply(12345, v1::CommandResult());
    const auto client = join(app, 0);
    EXPECT_FALSE(client->closed());
}

TEST(Ctl, SendsOneCommandAndReturnsItsResult) {
    FakeApp app;
    app.publishEvery(5ms, 64);
    const auto result =
        client::sendCommand({.url = app.url(), .timeout = patience}, *client::commandFrom({"pause"}), {}, {});
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_EQ(client::resultText(*result), "applied at step 7");
    ASSERT_EQ(app.commands().size(), 1U);
    EXPECT_TRUE(app.commands()[0].has_pause());
}

TEST(Ctl, ReturnsARefusalAsAResult) {
    FakeApp app;
    app.takesCommands = false;
    const auto result =
        client::sendCommand({.url = app.url(), .timeout = patience}, *client::commandFrom({"reset"}), {}, {});
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_EQ(client::resultText(*result), "refused: the command queue is full");
}

TEST(Ctl, ReportsThatNoServerListens) {
    std::string url;
    {
        const FakeApp app;
        url = app.url();
    }
    const auto result = client::sendCommand({.url = url, .timeout = patience}, *client::commandFrom({"reset"}), {}, {});
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().text().find("cannot be reached"), std::string::npos) << result.error().text();
}

TEST(Ctl, ReportsCloseReason) {
    FakeApp app;
    v1::Command command;
    command.mutable_load()->mutable_scene()->set_description(std::string(Options().maxMessageBytes, 'x'));
    const auto result = client::sendCommand({.url = app.url(), .timeout = patience}, command, {}, {});
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().text().find("1009"), std::string::npos) << result.error().text();
}

}  // namespace
}  // namespace spherule::net
