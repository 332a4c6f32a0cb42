// Inspections leave nearly all the time to the simulation.
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "fake_publisher.h"
#include "host/command_executor.h"

namespace spherule::host {
namespace {

class Answers : public FakePublisher {
  public:
    void reply(net::SessionId session, v1::CommandResult result) override {
        all.emplace_back(session, std::move(result));
    }
    std::vector<std::pair<net::SessionId, v1::CommandResult>> all;
};

class NoEffects : public CommandExecutor::Effects {
    Result<void> startRecording() override { return {}; }
    Result<void> stopRecording() override { return {}; }
    void worldChanged() override {}
    void publishChanges() override {}
    void reloaded(const Result<sim::Applied>& /*done*/) override {}
    void carriedOut(const checkpoint::Keeper::Place& /*at*/, const Request& /*request*/) override {}
    Result<void> checkCheckpoints() override { return {}; }
};

class Inspections : public testing::Test {
  protected:
    void ask(std::uint64_t session, std::uint64_t sphere) {
        Request request{.session = session, .command = {}};
        request.command.set_id(sphere);
        request.command.mutable_inspect()->set_sphere(sphere);
        EXPECT_FALSE(requests_.push(std::move(request)));
    }

    std::unique_ptr<SimulationHost> host_ = std::move(*SimulationHost::open("cpu:1", "billiards", {}));
    Requests requests_;
    Answers answers_;
    NoEffects effects_;
    CommandExecutor executor_{*host_, requests_, answers_, effects_};
};

TEST_F(Inspections, RestAfterEachSphere) {
    for (std::uint64_t session = 1; session <= 8; ++session) ask(session, session);
    executor_.answerQueries();
    EXPECT_GE(answers_.all.size(), 1U);
    EXPECT_LT(answers_.all.size(), 8U) << "the simulation goes on in between";
    ASSERT_TRUE(executor_.due());
    for (int turn = 0; turn < 10'000'000 && answers_.all.size() < 8; ++turn) executor_.answerQueries();
    ASSERT_EQ(answers_.all.size(), 8U);
    EXPECT_FALSE(executor_.due());
    for (std::size_t k = 0; k < answers_.all.size(); ++k) {
        EXPECT_EQ(answers_.all[k].first, k + 1) << "in the order of the questions";
        EXPECT_EQ(answers_.all[k].second.applied().inspected().sphere(), k + 1);
    }
}

TEST_F(Inspections, OfOneSphereAreAnsweredTogether) {
    for (std::uint64_t session = 1; session <= 8; ++session) ask(session, 3);
    executor_.answerQueries();
    EXPECT_EQ(answers_.all.size(), 8U);
}

}  // namespace
}  // namespace spherule::host
