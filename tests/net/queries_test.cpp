// Viewers that send queries at the highest allowed rate, and a controller, with the real server and simulation.
#include <algorithm>
#include <memory>
#include <set>
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

// Viewers that send a query every 10 ms each, as many commands as a session may send.
class Viewers {
  public:
    Viewers(std::uint16_t port, int count) {
        v1::ClientMessage query;
        query.mutable_command()->set_id(1);
        query.mutable_command()->mutable_query();
        query_ = query.SerializeAsString();
        for (int k = 0; k < count; ++k) {
            sockets_.push_back(std::make_unique<RawSocket>(port));
            EXPECT_EQ(sockets_.back()->openStream().substr(0, 12), "HTTP/1.1 101");
            sockets_.back()->sendFrame(binaryFrame, helloOf(0).SerializeAsString());
        }
        thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
    }

  private:
    void work(const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            for (const auto& socket : sockets_) {
                socket->sendFrame(binaryFrame, query_);
                socket->drain();
            }
            std::this_thread::sleep_for(10ms);
        }
    }

    std::string query_;
    std::vector<std::unique_ptr<RawSocket>> sockets_;
    std::jthread thread_;
};

class Controller {
  public:
    explicit Controller(std::uint16_t port)
        : client_(std::move(*Client::connect("ws://127.0.0.1:" + std::to_string(port) + "/ws", patience))) {
        EXPECT_TRUE(client_->send(helloOf(0)));
    }

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

  private:
    std::unique_ptr<Client> client_;
    std::uint64_t id_ = 0;
};

// Statistics cost a pass over all spheres. However many viewers ask, and however short the steps are, the server
// measures them at most ten times a second.
TEST(Queries, OfFortyViewersShareTheirAnswers) {
    const auto host = serve();
    const Viewers viewers(host->port(), 40);
    Controller controller(host->port());
    (void)controller.give(R"("set":{"speed":100,"substeps":1})");
    std::set<std::uint64_t> measured;  // steps
    const auto begin = Clock::now();
    for (int k = 0; k < 60; ++k) measured.insert(controller.give(R"("query":{})").statistics().step());
    const auto tenths = (Clock::now() - begin) / 100ms;
    EXPECT_LE(measured.size(), static_cast<std::size_t>(tenths + 2));
    EXPECT_TRUE(host->drain());
}

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
