#include <algorithm>

#include "fake_app.h"

namespace spherule::net {
namespace {

TEST(Stream, SendsStateBeforeFramesWithoutGap) {
    FakeApp app;
    const auto client = connect(app);
    ASSERT_TRUE(client->send(helloOf(60)));

    const auto welcome = next(*client);
    ASSERT_TRUE(welcome.has_welcome());
    EXPECT_EQ(welcome.welcome().server(), "fake app, for a test");
    EXPECT_EQ(next(*client).stream().rate(), 60U);
    EXPECT_EQ(next(*client).scene().name(), "synthetic");
    EXPECT_EQ(next(*client).settings().substeps(), 8U);
    EXPECT_EQ(next(*client).order().number(), 1U);
    app.publish(64);
    const auto first = next(*client);
    ASSERT_TRUE(first.has_frame());
    EXPECT_EQ(first.frame().spb().size(), 384U);
    app.publish(64);
    EXPECT_EQ(next(*client).frame().sequence(), first.frame().sequence() + 1);
}

TEST(Stream, DefaultsToThirtyFramesAndAllowsSixty) {
    FakeApp app;
    v1::ClientMessage hello;
    hello.mutable_hello();
    const auto plain = connect(app);
    ASSERT_TRUE(plain->send(hello));
    EXPECT_TRUE(next(*plain).has_welcome());
    const v1::Stream granted = next(*plain).stream();
    EXPECT_EQ(granted.rate(), 30U);
    EXPECT_EQ(granted.tier(), v1::NORMAL);
    EXPECT_FALSE(granted.reduced());
    const auto greedy = connect(app);
    ASSERT_TRUE(greedy->send(helloOf(1000)));
    EXPECT_TRUE(next(*greedy).has_welcome());
    EXPECT_EQ(next(*greedy).stream().rate(), 60U);
    EXPECT_TRUE(eventually([&] { return app.server().viewers() == 2 && app.server().subscriptions().size() == 2; }));
}

// A client that decodes frames with turns gets another chain than one that does not, at lower rates too.
TEST(Stream, SendsFramesWithTurnsToClientsThatDecodeThem) {
    FakeApp app;
    const auto plain = connect(app);
    ASSERT_TRUE(plain->send(helloOf(60)));
    const auto turning = connect(app);
    v1::ClientMessage hello = helloOf(60);
    hello.mutable_hello()->set_turns(true);
    ASSERT_TRUE(turning->send(hello));
    const auto wants = [&](std::uint32_t rate, bool turns) {
        return std::ranges::any_of(app.server().subscriptions(), [&](const codec::Subscription& one) {
            return one.rendition == codec::Rendition{v1::NORMAL, rate, turns};
        });
    };
    EXPECT_TRUE(eventually([&] { return wants(60, false) && wants(60, true); }));
    v1::ClientMessage view;
    view.mutable_view()->set_rate(10);
    ASSERT_TRUE(turning->send(view));
    EXPECT_TRUE(eventually([&] { return wants(60, false) && wants(10, true) && !wants(60, true); }));
}

TEST(Stream, ChangesRenditionOnRequest) {
    FakeApp app;
    app.publishEvery(10ms, 64);
    const auto client = join(app, 60);
    EXPECT_EQ(next(*client).frame().tier(), v1::NORMAL);
    v1::ClientMessage view;
    view.mutable_view()->set_rate(10);
    view.mutable_view()->set_tier(v1::FINE);
    ASSERT_TRUE(client->send(view));
    v1::ServerMessage message;
    do message = next(*client);
    while (message.has_frame() && message.frame().tier() == v1::NORMAL);
    EXPECT_EQ(message.stream().tier(), v1::FINE);
    EXPECT_EQ(message.stream().rate(), 10U);
    EXPECT_EQ(next(*client).frame().tier(), v1::FINE);
    view.mutable_view()->set_rate(0);
    ASSERT_TRUE(client->send(view));
    EXPECT_TRUE(eventually([&] { return app.server().viewers() == 0; }));
}

TEST(Stream, SendsKeyframeAfterClientReportsLoss) {
    FakeApp app;
    const auto client = join(app, 60);
    const auto other = join(app, 60);
    ASSERT_TRUE(eventually([&] { return app.server().viewers() == 2; }));
    app.publish(64);
    EXPECT_EQ(next(*client).frame().sequence(), 1U);
    EXPECT_EQ(next(*other).frame().sequence(), 1U);
    v1::ClientMessage ack;
    ack.mutable_ack()->set_sequence(1);
    ack.mutable_ack()->set_lost(true);
    ASSERT_TRUE(client->send(ack));
    ASSERT_TRUE(eventually([&] { return app.server().subscriptions().front().lost; }));
    EXPECT_EQ(app.counters().chainsLost, 1U);
    app.publish(64);
    EXPECT_EQ(next(*client).frame().sequence(), 2U);
    EXPECT_EQ(next(*other).frame().sequence(), 2U);
    EXPECT_FALSE(app.server().subscriptions().front().lost);
}

// The io thread is busy during two frames, so only the second one reaches the session.
TEST(Stream, RequestsKeyframeWhenAFrameWasReplaced) {
    FakeApp app;
    const auto client = join(app, 60);
    ASSERT_TRUE(eventually([&] { return app.server().viewers() == 1; }));
    const codec::Rendition rendition{v1::NORMAL, 60};
    const auto give = [&](codec::EncodedFrame::Kind kind, std::uint32_t number) {
        app.server().publish(encodedFrame(kind, number, 1, 64, rendition));
    };
    give(codec::EncodedFrame::Kind::Resync, 1);
    EXPECT_EQ(next(*client).frame().sequence(), 1U);
    give(codec::EncodedFrame::Kind::Delta, 3);
    ASSERT_TRUE(eventually([&] { return app.server().subscriptions().front().lost; })) << "no write is in progress";
    EXPECT_EQ(app.counters().chainsLost, 1U);
    give(codec::EncodedFrame::Kind::Resync, 3);
    EXPECT_EQ(next(*client).frame().sequence(), 3U);
}

// A keyframe replaced by a delta frame must be requested again, or no frame ever comes.
TEST(Stream, RequestsAReplacedKeyframeAgain) {
    FakeApp app;
    const auto client = join(app, 60);
    ASSERT_TRUE(eventually([&] { return app.server().viewers() == 1; }));
    const codec::Rendition rendition{v1::NORMAL, 60};
    app.hold = true;
    v1::ClientMessage command;
    command.mutable_command()->mutable_query();
    ASSERT_TRUE(client->send(command));
    ASSERT_TRUE(eventually([&] { return app.held.load(); }));
    app.server().publish(encodedFrame(codec::EncodedFrame::Kind::Resync, 1, 1, 64, rendition));
    EXPECT_FALSE(app.server().subscriptions().front().newcomer);
    app.server().publish(encodedFrame(codec::EncodedFrame::Kind::Delta, 2, 1, 64, rendition));
    app.hold = false;
    EXPECT_TRUE(next(*client).has_result());
    ASSERT_TRUE(eventually([&] { return app.server().subscriptions().front().lost; }));
    app.server().publish(encodedFrame(codec::EncodedFrame::Kind::Resync, 2, 1, 64, rendition));
    EXPECT_EQ(next(*client).frame().sequence(), 2U);
}

TEST(Stream, SendsAQuarterOfASecondWithoutAcks) {
    FakeApp app;
    const auto client = join(app, 60);
    ASSERT_TRUE(eventually([&] { return app.server().viewers() == 1; }));
    app.publish(64);
    v1::ClientMessage ack;
    ack.mutable_ack()->set_sequence(next(*client).frame().sequence());
    ASSERT_TRUE(client->send(ack));
    std::this_thread::sleep_for(100ms);
    app.publishEvery(5ms, 64);
    int frames = 0;
    for (;;) {
        const auto received = client->receive(400ms);
        ASSERT_TRUE(received);
        if (!*received) break;
        if ((*received)->has_frame()) ++frames;
    }
    EXPECT_GE(frames, 1);
    EXPECT_LE(frames, 15);
    EXPECT_GE(app.counters().chainsLost, 1U);
}

TEST(Stream, AnswersATextHelloInJson) {
    FakeApp app;
    app.publishEvery(10ms, 64);
    const auto client = connect(app);
    ASSERT_TRUE(client->sendBytes(R"({"hello":{"client":"shell","view":{"rate":60}}})", Encoding::Text));
    EXPECT_TRUE(next(*client).has_welcome());
    EXPECT_EQ(client->receivedAs(), Encoding::Text);
    EXPECT_TRUE(next(*client).has_stream());
    EXPECT_TRUE(next(*client).has_scene());
    EXPECT_TRUE(next(*client).has_settings());
    EXPECT_TRUE(next(*client).has_order());
    const auto state = next(*client);
    EXPECT_EQ(client->receivedAs(), Encoding::Text);
    const std::string expected(384, static_cast<char>(state.frame().sequence()));
    EXPECT_EQ(state.frame().spb(), expected);
}

TEST(Stream, SendsTheSameStatesToTwoClients) {
    FakeApp app;
    const auto one = join(app, 60);
    const auto two = join(app, 60);
    app.publishEvery(40ms, 64);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(next(*one).frame().SerializeAsString(), next(*two).frame().SerializeAsString());
    }
}

TEST(Stream, RequestsKeyframeForEachNewSession) {
    FakeApp app;
    const auto first = join(app, 60);
    ASSERT_TRUE(eventually([&] { return app.server().viewers() == 1; }));
    app.publish(64);
    EXPECT_EQ(next(*first).frame().sequence(), 1U);
    EXPECT_FALSE(app.server().subscriptions().front().newcomer);
    const auto second = join(app, 60);
    ASSERT_TRUE(eventually([&] { return app.server().viewers() == 2; }));
    EXPECT_TRUE(app.server().subscriptions().front().newcomer);
    app.server().publish(encodedFrame(codec::EncodedFrame::Kind::Resync, 1, 1, 64));
    EXPECT_EQ(next(*second).frame().sequence(), 1U);
    const auto none = first->receive(100ms);
    EXPECT_TRUE(none && !*none) << "this client has that state already";
}

TEST(Stream, SendsNothingForRateZero) {
    FakeApp app;
    const auto client = join(app, 0);
    EXPECT_EQ(app.server().viewers(), 0U);
    EXPECT_TRUE(app.server().subscriptions().empty());
    app.publishEvery(10ms, 64);
    const auto received = client->receive(200ms);
    ASSERT_TRUE(received);
    EXPECT_FALSE(received->has_value());
}

TEST(Stream, SendsFactsBeforeStatesOfAnEpoch) {
    FakeApp app;
    app.publishEvery(1ms, 64);
    const auto client = join(app, 60);
    std::jthread changer([&app](const std::stop_token& stop) {
        for (std::uint32_t epoch = 2; !stop.stop_requested(); ++epoch) {
            app.setEpoch(epoch);
            std::this_thread::sleep_for(7ms);
        }
    });
    std::uint32_t epoch = 1;
    int states = 0;
    const auto end = std::chrono::steady_clock::now() + 1s;
    while (std::chrono::steady_clock::now() < end) {
        const auto message = next(*client);
        if (message.has_scene()) epoch = message.scene().epoch();
        if (!message.has_frame()) continue;
        ++states;
        ASSERT_EQ(message.frame().epoch(), epoch);
    }
    EXPECT_GT(states, 5);
    EXPECT_GT(epoch, 5U);
}

TEST(Stream, HoldsAFrameUntilItsFactsAndOrderCome) {
    FakeApp app;
    const auto client = join(app, 60);
    ASSERT_TRUE(eventually([&] { return app.server().viewers() == 1; }));
    app.server().publish(encodedFrame(codec::EncodedFrame::Kind::Keyframe, 1, 2, 64));
    app.server().retain(factsOf(2, 64));
    app.server().setOrder(orderOf(2), codec::Audience::Everybody);
    EXPECT_EQ(next(*client).scene().epoch(), 2U);
    EXPECT_EQ(next(*client).order().epoch(), 2U);
    EXPECT_EQ(next(*client).frame().epoch(), 2U);
}

TEST(Stream, BroadcastsEventsAndSettings) {
    FakeApp app;
    const auto one = join(app, 0);
    const auto two = join(app, 0);
    app.server().broadcast(eventOf("mind the gap"));
    v1::ServerMessage settings;
    settings.mutable_settings()->set_substeps(9);
    app.server().retain(std::make_shared<codec::Message>(std::move(settings)));
    for (Client* client : {one.get(), two.get()}) {
        EXPECT_EQ(next(*client).event().text(), "mind the gap");
        EXPECT_EQ(next(*client).settings().substeps(), 9U);
    }
}

}  // namespace
}  // namespace spherule::net
