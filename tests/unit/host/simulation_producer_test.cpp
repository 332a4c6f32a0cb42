#include "host/simulation_producer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <google/protobuf/util/json_util.h>

#include "fake_publisher.h"
#include "recording_support.h"

namespace spherule::host {
namespace {

using namespace std::chrono_literals;

// A SimulationProducer without a network. Queues commands of sessions, and keeps the answers in order.
class TestSessions : private FakePublisher {
  public:
    explicit TestSessions(const std::string& scene = "two-spheres", std::unique_ptr<SceneWatch> watch = nullptr)
        : producer_(std::move(*SimulationHost::open("cpu:1", scene, {})), {requests_, board_, *this, saver_},
                    diagnostics::ownTable(), recording::LiveOptions(), std::move(watch)) {}

    // Queues a command; returns its id, which counts from 1.
    std::uint64_t give(const std::string& json, std::uint64_t session = 1) {
        v1::Command command;
        EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(json, &command).ok()) << json;
        command.set_id(++given_);
        EXPECT_FALSE(requests_.push({.session = session, .command = std::move(command)}));
        return given_;
    }

    // Runs until `enough` returns true. It is called after each answer and each retained message.
    void run(std::function<bool()> enough) {
        enough_ = std::move(enough);
        EXPECT_TRUE(producer_.run(stop_.get_token()));
    }
    // Runs until all commands have an answer.
    void run() {
        run([this] { return answers.size() >= given_; });
    }

    [[nodiscard]] const v1::CommandResult& answer(std::uint64_t id) const {
        for (const v1::CommandResult& result : answers)
            if (result.id() == id) return result;
        ADD_FAILURE() << "command " << id << " has no answer";
        return v1::CommandResult::default_instance();
    }
    [[nodiscard]] std::string refusal(std::uint64_t id) const { return answer(id).refused().reason(); }
    // Returns the position of the command's answer among all answers.
    [[nodiscard]] std::size_t placeOf(std::uint64_t id) const {
        for (std::size_t k = 0; k < answers.size(); ++k)
            if (answers[k].id() == id) return k;
        return answers.size();
    }

    std::vector<v1::CommandResult> answers;
    std::vector<v1::Change> changes;  // the changes sent to all sessions
    struct Told {
        net::SessionId by;
        v1::Event event;
    };
    std::vector<Told> told;  // events about commands, for the other sessions
    std::vector<std::string> warnings;

  private:
    void look() {
        if (enough_ && enough_()) stop_.request_stop();
    }
    void retain(codec::SharedMessage message, codec::Audience) override {
        if (message->content().has_change()) changes.push_back(message->content().change());
        look();
    }
    void broadcast(codec::SharedMessage message) override {
        if (message->content().event().kind() == v1::Event::WARNING)
            warnings.push_back(message->content().event().text());
        look();
    }
    void announce(net::SessionId by, v1::Event event) override { told.push_back({by, std::move(event)}); }
    void reply(net::SessionId, v1::CommandResult result) override {
        answers.push_back(std::move(result));
        look();
    }

    Requests requests_;
    SceneSaver saver_;
    StatusBoard board_;
    std::stop_source stop_;
    std::function<bool()> enough_;
    std::uint64_t given_ = 0;
    SimulationProducer producer_;
};

// 1,000 spheres almost in one point. It takes hundreds of sweeps to push them apart.
constexpr const char* crowd = R"({"load":{"scene":{"name":"crowd","bounds":{"min":[-1,-1,-1],"max":[1,1,1]},
    "groups":[{"radius":{"constant":0.05},"lattice":{"min":[-0.1,-0.1,-0.1],"max":[0.1,0.1,0.1],"spacing":1e-6,
                                                     "count":1000}}]}}})";
// In this dense scene, the search for random places without overlaps takes many seconds.
constexpr const char* packed = R"({"load":{"scene":{"name":"packed","bounds":{"min":[-1,-1,-1],"max":[1,1,1]},
    "groups":[{"radius":{"constant":0.01},"fill":{"min":[-1,-1,-1],"max":[1,1,1],"count":700000}}]}}})";

TEST(SimulationProducer, StepCommandIsAnsweredWhenItsStepsAreDone) {
    TestSessions sessions;
    const auto first = sessions.give(R"({"step":{"count":30}})");
    const auto second = sessions.give(R"({"step":{"count":4}})");
    const auto pause = sessions.give(R"({"pause":{}})");
    sessions.run();
    // The pause ends both, because it comes before they are done.
    EXPECT_NE(sessions.refusal(first).find("of 30 steps"), std::string::npos) << sessions.refusal(first);
    EXPECT_EQ(sessions.refusal(second).rfind("0 of 4 steps", 0), 0U) << sessions.refusal(second);
    EXPECT_TRUE(sessions.answer(pause).has_applied());

    TestSessions other;
    const auto many = other.give(R"({"step":{"count":30}})");
    const auto few = other.give(R"({"step":{"count":4}})", 2);
    other.run();
    EXPECT_EQ(other.answer(many).applied().step(), 30U);
    EXPECT_EQ(other.answer(few).applied().step(), 34U);
}

TEST(SimulationProducer, PauseAndCancelAreAnsweredWhileASceneLoads) {
    for (const char* scene : {crowd, packed}) {
        TestSessions sessions;
        const auto load = sessions.give(scene);
        const auto pause = sessions.give(R"({"pause":{}})", 2);
        const auto resume = sessions.give(R"({"resume":{}})", 2);
        const auto cancel = sessions.give(R"({"cancel":{}})", 2);
        const auto again = sessions.give(R"({"cancel":{}})", 2);
        sessions.run();
        EXPECT_TRUE(sessions.answer(pause).has_applied());
        EXPECT_TRUE(sessions.answer(resume).has_applied());
        EXPECT_TRUE(sessions.answer(cancel).has_applied());
        EXPECT_EQ(sessions.refusal(load), "cancelled");
        EXPECT_EQ(sessions.answer(load).refused().cause(), v1::Refused::CANCELLED);
        EXPECT_EQ(sessions.answer(again).refused().cause(), v1::Refused::NOTHING_TO_CANCEL);
        EXPECT_NE(sessions.refusal(again).find("nothing is under way"), std::string::npos);
        EXPECT_LT(sessions.placeOf(pause), sessions.placeOf(load));
    }
}

TEST(SimulationProducer, NewLoadReplacesTheLoadInProgress) {
    TestSessions sessions;
    const auto first = sessions.give(packed);
    const auto waits = sessions.give(R"({"set":{"gravity":[0,0,1]}})", 3);
    const auto second = sessions.give(crowd, 2);
    const auto wrong = sessions.give(R"({"load":{"name":"nothing"}})");
    const auto third = sessions.give(R"({"load":{"name":"cradle"}})");
    sessions.run();
    EXPECT_NE(sessions.refusal(first).find("session 2 has asked for load crowd"), std::string::npos);
    EXPECT_NE(sessions.refusal(waits).find(" has asked for load "), std::string::npos);
    EXPECT_NE(sessions.refusal(second).find("session 1 has asked for load cradle"), std::string::npos);
    EXPECT_NE(sessions.refusal(wrong).find("known are"), std::string::npos);
    EXPECT_TRUE(sessions.answer(third).has_applied());
}

TEST(SimulationProducer, CommandsWaitForAChangeAndAreRefusedIfItTakesLong) {
    TestSessions sessions;
    const auto load = sessions.give(packed);
    const auto set = sessions.give(R"({"set":{"gravity":[0,0,1]}})", 2);
    const auto push = sessions.give(R"({"push":{"sphere":0,"impulse":[0,0,0.1]}})", 2);
    sessions.run([&] { return sessions.answers.size() == 2; });
    for (const auto id : {set, push}) {
        EXPECT_NE(sessions.refusal(id).find("load packed is under way (placing spheres"), std::string::npos)
            << sessions.refusal(id);
        EXPECT_NE(sessions.refusal(id).find("cancel"), std::string::npos);
    }
    // When the loop ends, it refuses pending commands.
    EXPECT_EQ(sessions.refusal(load), "the server is stopping");

    TestSessions quick;
    const auto friction = quick.give(R"({"set":{"friction":0.3}})");  // needs other arrays and kernels
    const auto gravity = quick.give(R"({"set":{"gravity":[0,0,1]}})", 2);
    quick.run();
    EXPECT_TRUE(quick.answer(friction).has_applied());
    // On a busy machine, the first command may take so long that the second is refused.
    EXPECT_TRUE(quick.answer(gravity).has_applied() || quick.refusal(gravity).find("set is under way") == 0);
    if (quick.answer(gravity).has_applied()) {
        EXPECT_LT(quick.placeOf(friction), quick.placeOf(gravity));
    }
}

// Commands of one session run in order. A later pause or resume ends a step that waits for a load.
TEST(SimulationProducer, PauseOrResumeEndsStepsThatWaitForAChange) {
    for (const char* later : {R"({"resume":{}})", R"({"pause":{}})"}) {
        TestSessions sessions;
        const auto load = sessions.give(R"({"load":{"name":"cradle"}})");
        const auto step = sessions.give(R"({"step":{"count":10}})");
        const auto end = sessions.give(later);
        sessions.run();
        EXPECT_TRUE(sessions.answer(load).has_applied());
        EXPECT_TRUE(sessions.answer(end).has_applied());
        EXPECT_NE(sessions.refusal(step).find("none of its steps were done"), std::string::npos)
            << sessions.refusal(step);
    }
}

TEST(SimulationProducer, TellsTheStateOfASphere) {
    TestSessions sessions("billiards");
    sessions.give(R"({"pause":{}})");
    const auto seen = sessions.give(R"({"inspect":{"sphere":3}})", 2);
    const auto same = sessions.give(R"({"inspect":{"sphere":3}})", 3);
    const auto other = sessions.give(R"({"inspect":{"sphere":0}})", 2);
    const auto none = sessions.give(R"({"inspect":{"sphere":1000}})", 2);
    sessions.run();
    const v1::Inspected& found = sessions.answer(seen).applied().inspected();
    EXPECT_EQ(found.sphere(), 3U);
    EXPECT_EQ(found.position_size(), 3);
    EXPECT_GT(found.mass(), 0);
    EXPECT_GE(found.contact_count(), 1U);
    EXPECT_EQ(static_cast<std::uint32_t>(found.contacts_size()), found.contact_count());
    EXPECT_EQ(sessions.answer(same).applied().inspected().SerializeAsString(), found.SerializeAsString());
    EXPECT_EQ(sessions.answer(other).applied().inspected().sphere(), 0U);
    EXPECT_EQ(sessions.answer(none).refused().cause(), v1::Refused::NO_SUCH_SPHERE);
    EXPECT_EQ(sessions.answer(none).refused().field(), "inspect.sphere");
    EXPECT_TRUE(sessions.told.size() == 1) << "an inspection is nothing that others are told of";
}

// One session cannot keep others from asking.
TEST(SimulationProducer, LimitsTheInspectionsOfASession) {
    TestSessions sessions;
    for (int k = 0; k < 8; ++k) sessions.give(R"({"inspect":{"sphere":0}})", 5);
    const auto other = sessions.give(R"({"inspect":{"sphere":1}})", 6);
    sessions.run();
    EXPECT_TRUE(sessions.answer(other).has_applied());
    EXPECT_TRUE(sessions.answer(4).has_applied());
    EXPECT_EQ(sessions.answer(5).refused().cause(), v1::Refused::TOO_MANY_COMMANDS);
}

TEST(SimulationProducer, OthersAreToldOfCommandsThatChangeTheWorld) {
    TestSessions sessions("billiards");
    sessions.give(R"({"pause":{}})", 4);
    sessions.give(R"({"set":{"gravity":[0,0,-1.62]}})", 5);
    sessions.give(R"({"set":{"friction":-1}})", 5);  // refused
    sessions.give(R"({"push":{"sphere":0,"impulse":[0,0,0]}})", 5);
    sessions.give(R"({"spawn":{"group":{"name":"new","radius":{"constant":0.02},"list":{"spheres":[
        {"position":[0.1,0.1,0.2]},{"position":[0.2,0.1,0.2]}]}}}})",
                  5);
    sessions.run([&] { return sessions.answers.size() == 5; });
    ASSERT_EQ(sessions.answer(5).refused().reason(), "");
    ASSERT_EQ(sessions.told.size(), 3U);
    EXPECT_EQ(sessions.told[0].by, 4U);
    EXPECT_EQ(sessions.told[0].event.kind(), v1::Event::COMMANDED);
    EXPECT_TRUE(sessions.told[0].event.command().has_pause());
    EXPECT_EQ(sessions.told[1].by, 5U);
    EXPECT_EQ(sessions.told[1].event.command().set().gravity(2), -1.62);
    const v1::Event& spawned = sessions.told[2].event;
    EXPECT_EQ(spawned.spheres(), 2U);
    EXPECT_EQ(spawned.command().spawn().group().name(), "new");
    EXPECT_FALSE(spawned.command().spawn().group().has_list()) << "spheres may take megabytes";
}

// A client ends the load of a saved scene.
TEST(SimulationProducer, TellsThatASavedSceneIsNotLoaded) {
    for (const auto& [command, reason] :
         {std::pair(R"({"cancel":{}})", "cancelled"), {R"({"reset":{}})", "session 9 has asked for reset"}}) {
        const recording::TemporaryFolder folder;
        const std::string path = folder / "one.json";
        recording::writeFile(path, R"({"bounds":{"min":[-1,-1,-1],"max":[1,1,1]}})");
        TestSessions sessions(path, std::make_unique<SceneWatch>(path, 10ms));
        recording::writeFile(path, R"({"bounds":{"min":[-1,-1,-1],"max":[1,1,1]},"groups":[{"radius":{"constant":0.01},
            "fill":{"min":[-1,-1,-1],"max":[1,1,1],"count":700000}}]})");
        std::uint64_t given = 0;
        sessions.run([&, command = command] {
            if (given == 0 && !sessions.changes.empty()) given = sessions.give(command, 9);
            return !sessions.warnings.empty() && sessions.answers.size() == given;
        });
        EXPECT_EQ(sessions.changes.at(0).what(), "load one.json");
        EXPECT_TRUE(sessions.answer(given).has_applied());
        ASSERT_EQ(sessions.warnings.size(), 1U);
        EXPECT_EQ(sessions.warnings[0],
                  std::string("one.json was saved but is not loaded: ") + reason + ". Save it again to load it.");
    }
}

TEST(SimulationProducer, TellsThatTheWatchedSceneIsGone) {
    const recording::TemporaryFolder folder;
    const std::string path = folder / "one.json";
    recording::writeFile(path, R"({"bounds":{"min":[-1,-1,-1],"max":[1,1,1]}})");
    TestSessions sessions(path, std::make_unique<SceneWatch>(path, 10ms));
    std::filesystem::remove(path);
    sessions.run([&] { return !sessions.warnings.empty(); });
    EXPECT_EQ(sessions.warnings.at(0), "one.json is gone. The world goes on as it is. Save the file again to load it.");
    EXPECT_TRUE(sessions.changes.empty());
}

TEST(SimulationProducer, BroadcastsTheProgressOfALongChange) {
    TestSessions sessions;
    sessions.give(packed, 7);
    // On a busy machine, a shorter piece of work may last long enough for a message of its own.
    const auto places = [](const v1::Change& change) { return change.doing() == "placing spheres"; };
    sessions.run([&] { return std::ranges::count_if(sessions.changes, places) >= 3; });
    ASSERT_GE(std::ranges::count_if(sessions.changes, places), 3);
    for (const v1::Change& change : sessions.changes) {
        EXPECT_EQ(change.what(), "load packed");
        EXPECT_EQ(change.session(), 7U);
        if (!places(change)) continue;
        EXPECT_GT(change.share(), 0);
        EXPECT_LT(change.share(), 1);
    }
}

// A SimulationProducer with one sphere that lies on the floor, and a viewer that takes frames.
class PausedSimulation : public testing::Test, private FakePublisher {
  protected:
    PausedSimulation() {
        recording::writeFile(folder_ / "one.json", R"({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]},
            "groups": [{"list": {"spheres": [{"position": [0.5, 0.5, 0.05]}]}, "radius": {"constant": 0.05}}]})");
        thread_ = std::jthread([this](const std::stop_token& stop) {
            SimulationProducer producer(SimulationHost::open("cpu:1", folder_ / "one.json", {}).value(),
                                        {requests_, board_, *this, saver_}, diagnostics::ownTable(),
                                        recording::LiveOptions());
            EXPECT_TRUE(producer.run(stop));
        });
    }

    void tell(const v1::Command& command) { ASSERT_FALSE(requests_.push({.session = 1, .command = command})); }
    void step(std::uint32_t count) {
        v1::Command command;
        command.mutable_step()->set_count(count);
        tell(command);
    }
    // Waits for the first frame of a step.
    v1::Frame frameOf(std::uint64_t step) {
        std::unique_lock lock(mutex_);
        v1::Frame found;
        EXPECT_TRUE(changed_.wait_for(lock, 15s, [&] {
            for (const v1::Frame& frame : frames_) {
                if (frame.step() != step) continue;
                found = frame;
                return true;
            }
            return false;
        }));
        return found;
    }

  private:
    void publish(const codec::EncodedFrame& encoded) override {
        const std::scoped_lock lock(mutex_);
        frames_.push_back(encoded.message->content().frame());
        changed_.notify_all();
    }
    [[nodiscard]] std::uint32_t viewers() const override { return 1; }
    [[nodiscard]] std::vector<codec::Subscription> subscriptions() override {
        return {{.rendition = {v1::NORMAL, 60}}};
    }

    recording::TemporaryFolder folder_;
    Requests requests_;
    SceneSaver saver_;
    StatusBoard board_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<v1::Frame> frames_;
    std::jthread thread_;
};

TEST_F(PausedSimulation, FramesReportTheNumberOfSleepingSpheres) {
    v1::Command reset;
    reset.mutable_reset();
    v1::Command fast;
    fast.mutable_set()->set_speed(10);
    v1::Command pause;
    pause.mutable_pause();
    tell(pause);
    tell(reset);
    tell(fast);
    EXPECT_EQ(frameOf(0).status().sleeping(), 0U);
    // These steps take less time than the interval of diagnostics.
    step(60);
    EXPECT_EQ(frameOf(60).status().sleeping(), 1U);
    EXPECT_TRUE(frameOf(60).status().paused());
}

}  // namespace
}  // namespace spherule::host
