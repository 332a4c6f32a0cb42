#include "owner.h"

namespace spherule::net {
namespace {

TEST(Stream, GreetsWithWelcomeThenFactsThenSettingsThenStates) {
    Owner owner;
    owner.publishEvery(10ms, 64);
    const auto client = connect(owner);
    ASSERT_TRUE(client->send(helloOf(60)));

    const auto welcome = next(*client);
    ASSERT_TRUE(welcome.has_welcome());
    EXPECT_EQ(welcome.welcome().server(), "fake owner, for a test");
    EXPECT_EQ(welcome.welcome().rate(), 60U);
    EXPECT_EQ(next(*client).scene().name(), "synthetic");
    EXPECT_EQ(next(*client).settings().substeps(), 8U);
    const auto first = next(*client);
    ASSERT_TRUE(first.has_frame());
    EXPECT_EQ(first.frame().states().packed16().positions().size(), 384U);
    EXPECT_GT(next(*client).frame().sequence(), first.frame().sequence());
}

TEST(Stream, GrantsThirtyStatesWhenNoRateIsAskedAndSixtyAtMost) {
    Owner owner;
    v1::ClientMessage hello;
    hello.mutable_hello();
    const auto plain = connect(owner);
    ASSERT_TRUE(plain->send(hello));
    EXPECT_EQ(next(*plain).welcome().rate(), 30U);
    const auto greedy = connect(owner);
    ASSERT_TRUE(greedy->send(helloOf(1000)));
    EXPECT_EQ(next(*greedy).welcome().rate(), 60U);
    EXPECT_TRUE(eventually([&] { return owner.server().viewers() == 2 && owner.server().rate() == 60; }));
}

TEST(Stream, SpeaksJsonToAClientThatSaidHelloInText) {
    Owner owner;
    owner.publishEvery(10ms, 64);
    const auto client = connect(owner);
    ASSERT_TRUE(client->sendBytes(R"({"hello":{"client":"shell","rate":60}})", Encoding::Text));
    EXPECT_TRUE(next(*client).has_welcome());
    EXPECT_EQ(client->receivedAs(), Encoding::Text);
    EXPECT_TRUE(next(*client).has_scene());
    EXPECT_TRUE(next(*client).has_settings());
    const auto state = next(*client);
    EXPECT_EQ(client->receivedAs(), Encoding::Text);
    const std::string expected(384, static_cast<char>(state.frame().sequence()));
    EXPECT_EQ(state.frame().states().packed16().positions(), expected);
}

TEST(Stream, ShowsTwoClientsTheSameStates) {
    Owner owner;
    const auto one = join(owner, 60);
    const auto two = join(owner, 60);
    owner.publishEvery(40ms, 64);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(next(*one).frame().SerializeAsString(), next(*two).frame().SerializeAsString());
    }
}

TEST(Stream, GivesANewcomerTheLatestStateOfAPausedScene) {
    Owner owner;
    const auto first = join(owner, 60);
    ASSERT_TRUE(eventually([&] { return owner.server().viewers() == 1; }));
    owner.server().publish(stateOf(41, 1, 64));
    owner.server().publish(stateOf(42, 1, 64));
    const auto second = join(owner, 60);
    EXPECT_EQ(next(*second).frame().sequence(), 42U);
}

TEST(Stream, SendsNoStatesAndCountsNoViewerForRateZero) {
    Owner owner;
    const auto client = join(owner, 0);
    EXPECT_EQ(owner.server().viewers(), 0U);
    EXPECT_EQ(owner.server().rate(), 0U);
    owner.publishEvery(10ms, 64);
    const auto received = client->receive(200ms);
    ASSERT_TRUE(received);
    EXPECT_FALSE(received->has_value());
}

TEST(Stream, KeepsToTheRateAskedForAndEndsOnTheNewestState) {
    Owner owner;
    const auto client = join(owner, 10);
    owner.publishEvery(5ms, 64);
    int count = 0;
    std::uint64_t last = 0;
    const auto end = std::chrono::steady_clock::now() + 1500ms;
    while (std::chrono::steady_clock::now() < end) {
        last = next(*client).frame().sequence();
        ++count;
    }
    EXPECT_GE(count, 10);
    EXPECT_LE(count, 18);
    owner.stopPublishing();
    while (last != owner.published()) {
        const auto received = client->receive(1s);
        ASSERT_TRUE(received && *received) << "the newest state was never sent";
        last = (*received)->frame().sequence();
    }
    EXPECT_EQ(owner.counters().framesReplaced, 0U) << "what the rate skips is not what a busy session loses";
}

TEST(Stream, NeverShowsAStateBeforeTheFactsOfItsEpoch) {
    Owner owner;
    owner.publishEvery(1ms, 64);
    const auto client = join(owner, 60);
    std::jthread changer([&owner](const std::stop_token& stop) {
        for (std::uint32_t epoch = 2; !stop.stop_requested(); ++epoch) {
            owner.setEpoch(epoch);
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

TEST(Stream, HoldsAStateUntilTheFactsOfItsEpochCome) {
    Owner owner;
    const auto client = join(owner, 60);
    ASSERT_TRUE(eventually([&] { return owner.server().viewers() == 1; }));
    owner.server().publish(stateOf(1, 2, 64));
    owner.server().setScene(factsOf(2, 64));
    EXPECT_EQ(next(*client).scene().epoch(), 2U);
    EXPECT_EQ(next(*client).frame().epoch(), 2U);
}

TEST(Stream, TellsEveryoneOfEventsAndNewSettings) {
    Owner owner;
    const auto one = join(owner, 0);
    const auto two = join(owner, 0);
    owner.server().broadcast(eventOf("mind the gap"));
    v1::ServerMessage settings;
    settings.mutable_settings()->set_substeps(9);
    owner.server().setSettings(std::make_shared<frame::Message>(std::move(settings)));
    for (Client* client : {one.get(), two.get()}) {
        EXPECT_EQ(next(*client).event().text(), "mind the gap");
        EXPECT_EQ(next(*client).settings().substeps(), 9U);
    }
}

}  // namespace
}  // namespace spherule::net
