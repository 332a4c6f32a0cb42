// Replay of command logs: what no command line can provoke.
#include "host/replay.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>

#include "fake_publisher.h"
#include "host/simulation_producer.h"
#include "temporary_folder.h"

namespace spherule::host {
namespace {

// Asks for steps until a command was carried out, and ends the producer then.
class Asking : public FakePublisher {
  public:
    Asking(Requests& requests, std::uint32_t steps) : requests_(requests), steps_(steps) { ask(); }

    void reply(net::SessionId, v1::CommandResult result) override {
        if (result.has_applied()) {
            stop_.request_stop();
            return;
        }
        ++refused;
        ask();
    }
    void broadcast(codec::SharedMessage message) override {
        diverged += message->content().event().kind() == v1::Event::NON_FINITE ? 1 : 0;
    }
    [[nodiscard]] std::stop_token stop() { return stop_.get_token(); }

    unsigned refused = 0;
    unsigned diverged = 0;

  private:
    void ask() {
        v1::Command command;
        command.mutable_step()->set_count(steps_);
        EXPECT_FALSE(requests_.push({.session = 1, .command = std::move(command)}));
    }

    Requests& requests_;
    std::uint32_t steps_;
    std::stop_source stop_;
};

// A world that has become non-finite returns to its last good state. The log has this, too.
TEST(Replay, ReturnsToTheLastGoodState) {
    const support::TemporaryFolder folder;
    const std::string path = folder / "run.sphl";
    {
        checkpoint::Options options;
        options.log = path;
        options.hashEvery = 1;
        auto keeper = checkpoint::Keeper::open(options).value();
        auto host = SimulationHost::open("cpu:1", "cradle", {}).value();
        for (int k = 0; k < 30; ++k) ASSERT_TRUE(host->simulation().step());
        sim::State broken = host->simulation().snapshot();
        broken.velocity[0].x = std::numeric_limits<float>::quiet_NaN();
        host->simulation().upload(broken);
        Requests requests;
        StatusBoard board;
        SceneSaver saver;
        Asking asking(requests, 5);
        SimulationProducer producer(std::move(host), {requests, board, asking, saver}, diagnostics::ownTable(), {},
                                    nullptr, std::move(keeper));
        ASSERT_TRUE(producer.run(asking.stop()));
        EXPECT_EQ(asking.diverged, 1U);
        EXPECT_EQ(asking.refused, 1U) << "the steps after the return were not done";
    }
    const auto device = compute::openDevice("cpu:1").value();
    auto replay = Replay::open(path, *device).value();
    EXPECT_EQ(replay->simulation().steps(), 30U);
    while (replay->step().value()) EXPECT_FALSE(replay->firstMismatch());
    EXPECT_TRUE(replay->complete());
    EXPECT_FALSE(replay->firstMismatch());
    EXPECT_EQ(replay->counts().steps, 1U + 5U);
    EXPECT_EQ(replay->simulation().steps(), 5U);
    EXPECT_GE(replay->counts().hashes, 5U);
}

}  // namespace
}  // namespace spherule::host
