#include "fake_app.h"

#include <new>
#include <utility>

namespace spherule::net {

namespace {

const StaticFile file = {"text/css", {"as it is", "\"plain\""}, {"compressed", "\"gzip\""}};

}  // namespace

Options quickOptions() {
    Options options;
    options.port = 0;
    options.connectionLimits = {.sessions = 0, .sessionsPerAddress = 0, .connectionsPerSecond = 0};
    options.helloTimeout = 1s;
    options.drainTimeout = 2s;
    return options;
}

codec::SharedMessage factsOf(std::uint32_t epoch, std::uint32_t spheres) {
    v1::ServerMessage message;
    message.mutable_scene()->set_epoch(epoch);
    message.mutable_scene()->set_name("synthetic");
    message.mutable_scene()->set_count(spheres);
    return std::make_shared<codec::Message>(std::move(message));
}

codec::SharedMessage orderOf(std::uint32_t epoch) {
    v1::ServerMessage message;
    message.mutable_order()->set_epoch(epoch);
    message.mutable_order()->set_number(epoch);
    return codec::share(std::move(message));
}

codec::EncodedFrame encodedFrame(codec::EncodedFrame::Kind kind, std::uint32_t number, std::uint32_t epoch,
                                 std::uint32_t spheres, const codec::Rendition& rendition) {
    v1::ServerMessage message;
    v1::Frame& frame = *message.mutable_frame();
    frame.set_sequence(number);
    frame.set_epoch(epoch);
    frame.set_order(epoch);
    frame.set_step(number);
    frame.set_count(spheres);
    frame.set_tier(rendition.tier);
    frame.set_spb(std::string(std::size_t{6} * spheres, static_cast<char>(number)));
    return {rendition, kind, number, codec::share(std::move(message))};
}

codec::SharedMessage eventOf(const std::string& text, v1::Event::Kind kind) {
    v1::ServerMessage message;
    message.mutable_event()->set_kind(kind);
    message.mutable_event()->set_text(text);
    return std::make_shared<codec::Message>(std::move(message));
}

bool eventually(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
        if (condition()) return true;
        std::this_thread::sleep_for(5ms);
    }
    return false;
}

FakeApp::FakeApp(const Options& options) {
    folder_.write("one.sph", std::string(300'000, 'r'));
    auto started = startServer(options, handlers());
    if (!started) throw std::runtime_error(started.error().text());
    server_ = std::move(*started);
    setEpoch(1);
    v1::ServerMessage settings;
    settings.mutable_settings()->set_substeps(8);
    server_->retain(std::make_shared<codec::Message>(std::move(settings)));
}

FakeApp::~FakeApp() {
    stopPublishing();
    server_.reset();  // its thread uses the members declared after it
}

std::string FakeApp::url() const {
    return "ws://127.0.0.1:" + std::to_string(server_->port()) + "/ws";
}

void FakeApp::publish(std::uint32_t spheres) {
    using enum codec::EncodedFrame::Kind;
    const auto subscriptions = server_->subscriptions();
    const std::uint32_t number = ++number_;
    for (const codec::Subscription& subscription : subscriptions) {
        server_->publish(encodedFrame(Delta, number, epoch_, spheres, subscription.rendition));
        if (subscription.newcomer || subscription.lost)
            server_->publish(encodedFrame(Resync, number, epoch_, spheres, subscription.rendition));
    }
}

void FakeApp::publishEvery(std::chrono::milliseconds period, std::uint32_t spheres) {
    publisher_ = std::jthread([this, period, spheres](const std::stop_token& stop) {
        for (auto due = std::chrono::steady_clock::now(); !stop.stop_requested(); due += period) {
            publish(spheres);
            std::this_thread::sleep_until(due + period);
        }
    });
}

void FakeApp::stopPublishing() {
    publisher_ = {};
}

void FakeApp::setEpoch(std::uint32_t epoch) {
    server_->retain(factsOf(epoch, 64));
    server_->setOrder(orderOf(epoch), codec::Audience::Everybody);
    epoch_ = epoch;
}

std::vector<v1::Command> FakeApp::commands() {
    const std::lock_guard lock(mutex_);
    return commands_;
}

std::vector<SessionId> FakeApp::silenced() {
    const std::lock_guard lock(mutex_);
    return silenced_;
}

namespace {

class ThreeParts : public Document {
  public:
    std::string next() override { return part_ == 3 ? "" : "part " + std::to_string(++part_) + "\n"; }

  private:
    int part_ = 0;
};

}  // namespace

Handlers FakeApp::handlers() {
    return {
        .welcome =
            [](const v1::Hello& hello) {
                v1::Welcome welcome;
                welcome.set_server("fake app, for " + hello.client());
                return welcome;
            },
        .submit = [this](SessionId session, v1::Command command, std::size_t) -> Handlers::Refusal {
            if (throws) throw std::bad_alloc();
            if (!takesCommands) return "the command queue is full";
            for (; hold; std::this_thread::sleep_for(1ms)) held = true;
            v1::CommandResult result;
            result.set_id(command.id());
            result.mutable_applied()->set_step(7);
            {
                const std::lock_guard lock(mutex_);
                commands_.push_back(std::move(command));
            }
            server_->reply(session, std::move(result));
            return std::nullopt;
        },
        .mayNotCommand =
            [this](SessionId session) {
                const std::lock_guard lock(mutex_);
                silenced_.push_back(session);
            },
        .refuses =
            [this](SessionId, std::size_t) {
                return takesLong ? Handlers::Refusal() : Handlers::Refusal("the command queue is full");
            },
        .file = [](const std::string& path) { return path == "/file" ? &file : nullptr; },
        .download = [this](const std::string& path) -> std::optional<std::string> {
            if (path == "/recordings/one.sph" || path == "/recordings/gone.sph")
                return folder_ / path.substr(downloadsPath.size());
            return std::nullopt;
        },
        .saveScene =
            [this](const Handlers::Made& made) {
                if (takesCommands) return made(std::make_shared<ThreeParts>(), {});
                made(nullptr, {503, "text/plain; charset=utf-8", "another scene is being saved\n"});
            },
        .get =
            [this](const std::string& path, const Counters&) {
                if (throws) throw std::bad_alloc();
                if (path == "/healthz") return HttpAnswer{.status = 200, .contentType = "text/plain", .body = "well\n"};
                return HttpAnswer{.status = 404, .contentType = "text/plain", .body = "nothing at " + path + "\n"};
            },
    };
}

v1::ClientMessage helloOf(std::uint32_t rate) {
    v1::ClientMessage message;
    message.mutable_hello()->set_client("a test");
    message.mutable_hello()->mutable_view()->set_rate(rate);
    return message;
}

std::unique_ptr<Client> connect(const FakeApp& app) {
    auto client = Client::connect(app.url(), patience);
    if (!client) throw std::runtime_error(client.error().text());
    return std::move(*client);
}

std::unique_ptr<Client> join(const FakeApp& app, std::uint32_t rate, Encoding encoding) {
    auto client = connect(app);
    EXPECT_TRUE(client->send(helloOf(rate), encoding));
    EXPECT_TRUE(next(*client).has_welcome());
    EXPECT_TRUE(next(*client).has_stream());
    EXPECT_TRUE(next(*client).has_scene());
    EXPECT_TRUE(next(*client).has_settings());
    if (rate > 0) {
        EXPECT_TRUE(next(*client).has_order());
    }
    return client;
}

v1::ServerMessage next(Client& client) {
    auto received = client.receive(patience);
    if (!received) {
        ADD_FAILURE() << received.error().text();
        return {};
    }
    if (!*received) {
        ADD_FAILURE() << "no message came";
        return {};
    }
    return std::move(**received);
}

CloseFrame readToEnd(Client& client) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!client.closed() && std::chrono::steady_clock::now() < end) {
        if (!client.receive(100ms)) break;
    }
    if (!client.closed()) {
        ADD_FAILURE() << "the server did not close";
        return {};
    }
    return *client.closed();
}

}  // namespace spherule::net
