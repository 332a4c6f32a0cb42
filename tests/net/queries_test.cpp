// Viewers that send queries at the highest allowed rate, and a controller, with the real server and simulation.
#include <algorithm>
#include <limits>
#include <memory>
#include <stop_token>
#include <thread>
#include <vector>

#include "fake_app.h"
#include "host/host.h"
#include "host/simulation_producer.h"
#include "raw_socket.h"

namespace spherule::net {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint8_t binaryFrame = 0x82;

std::unique_ptr<host::Host> serve() {
    Options options = quickOptions();
    options.commandsPerSecond = 0;  // the viewers keep to the default limit by themselves

    auto server = host::Host::start(
        [](const host::ProducerIo& io) -> Result<std::unique_ptr<host::FrameProducer>> {
            // Without sleep, a step takes as long at the end as at the beginning.
            auto host = host::SimulationHost::open("cpu:1", "box-4k", {.noSleep = true});
            if (!host) return tl::unexpected(host.error());
            return std::make_unique<host::SimulationProducer>(std::move(*host), io, diagnostics::ownTable(),
                                                              recording::LiveOptions());
        },
        options, host::Watchdog::Seconds(0), [](const Error&) { return 1; });
    if (!server) throw std::runtime_error(server.error().text());
    EXPECT_TRUE(eventually([&] { return (*server)->opened(); }));
    return std::move(*server);
}

v1::ClientMessage statisticsQuery(std::uint64_t /*number*/) {
    v1::ClientMessage query;
    query.mutable_command()->mutable_query();
    return query;
}

// Another sphere each time.
v1::ClientMessage inspection(std::uint64_t number) {
    v1::ClientMessage inspect;
    inspect.mutable_command()->mutable_inspect()->set_sphere(number * 37 % 4000);
    return inspect;
}

// Each viewer sends a query every 10 ms, the command limit of one session, while `run` is true.
class Viewers {
  public:
    using Query = v1::ClientMessage (*)(std::uint64_t number);
    Viewers(std::uint16_t port, int count, Query query) : query_(query) {
        for (int k = 0; k < count; ++k) {
            sockets_.push_back(std::make_unique<RawSocket>(port));
            EXPECT_EQ(sockets_.back()->openStream().substr(0, 12), "HTTP/1.1 101");
            sockets_.back()->sendFrame(binaryFrame, helloOf(0).SerializeAsString());
        }
        thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
    }

    void ask(bool on) { asking_ = on; }

  private:
    void work(const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            for (const auto& socket : sockets_) {
                v1::ClientMessage query = query_(++asked_);
                query.mutable_command()->set_id(1);
                if (asking_) socket->sendFrame(binaryFrame, query.SerializeAsString());
                socket->drain();
            }
            std::this_thread::sleep_for(10ms);
        }
    }

    const Query query_;
    std::uint64_t asked_ = 0;
    std::atomic<bool> asking_ = false;
    std::vector<std::unique_ptr<RawSocket>> sockets_;
    std::jthread thread_;
};

class Controller {
  public:
    explicit Controller(std::uint16_t port)
        : client_(std::move(*Client::connect("ws://127.0.0.1:" + std::to_string(port) + "/ws", patience))) {
        EXPECT_TRUE(client_->send(helloOf(0)));
    }

    // Returns the time from a command to its result.
    v1::Applied give(const std::string& json) {
        const std::uint64_t id = ++id_;
        EXPECT_TRUE(
            client_->sendBytes(R"({"command":{"id":)" + std::to_string(id) + "," + json + "}}", Encoding::Text));
        for (;;) {
            const v1::ServerMessage message = next(*client_);
            if (message.kind_case() == v1::ServerMessage::KIND_NOT_SET) return {};
            if (!message.has_result() || message.result().id() != id) continue;
            EXPECT_TRUE(message.result().has_applied()) << message.ShortDebugString();
            return message.result().applied();
        }
    }

    // The mean time from one step to the next (s), over four steps of a running simulation.
    double timePerStep() {
        const std::string command = R"("set":{"speed":100})";  // changes nothing
        const std::uint64_t first = give(command).step();
        const auto begin = Clock::now();
        std::uint64_t last = first;
        while (last < first + 4 && !testing::Test::HasFailure()) last = give(command).step();
        return std::chrono::duration<double>(Clock::now() - begin).count() / static_cast<double>(last - first);
    }

  private:
    std::unique_ptr<Client> client_;
    std::uint64_t id_ = 0;
};

class FromFortyViewers : public testing::TestWithParam<Viewers::Query> {};

// The simulation runs without pauses, so a command waits for the end of a step. A step of 400 substeps is longer than
// the queries that may be answered between two steps.
TEST_P(FromFortyViewers, DoNotDelayCommands) {
    const auto host = serve();
    Viewers viewers(host->port(), 40, GetParam());
    Controller controller(host->port());
    (void)controller.give(R"("set":{"speed":100,"substeps":400})");
    // Other load of the machine only adds time, so the shortest times are compared.
    double shortest[2]{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    for (int round = 0; round < 12; ++round) {
        for (const bool asked : {false, true}) {
            viewers.ask(asked);
            (void)controller.give(R"("set":{"speed":100})");  // earlier queries end
            shortest[asked] = std::min(shortest[asked], controller.timePerStep());
        }
    }
    EXPECT_LE(shortest[1] / shortest[0], 1.5);
    EXPECT_TRUE(host->drain());
}

INSTANTIATE_TEST_SUITE_P(Queries, FromFortyViewers, testing::Values(statisticsQuery, inspection),
                         [](const auto& parameter) { return parameter.index == 0 ? "ForStatistics" : "ForSpheres"; });

TEST(Queries, SeeEarlierCommands) {
    const auto host = serve();
    Controller controller(host->port());
    (void)controller.give(R"("pause":{})");
    const auto paused = controller.give(R"("query":{})").statistics();
    EXPECT_EQ(paused.spheres(), 4000U);
    (void)controller.give(R"("load":{"name":"cradle"})");
    EXPECT_EQ(controller.give(R"("query":{})").statistics().spheres(), 5U);
    for (std::uint64_t step = 1; step <= 5; ++step) {
        (void)controller.give(R"("step":{"count":1})");
        EXPECT_TRUE(eventually([&] { return controller.give(R"("query":{})").statistics().step() == step; }));
    }
    (void)controller.give(R"("push":{"sphere":0,"impulse":[0,0,5]})");
    EXPECT_GT(controller.give(R"("query":{})").statistics().momentum(2), 4);
    EXPECT_TRUE(host->drain());
}

}  // namespace
}  // namespace spherule::net
