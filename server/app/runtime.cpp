#include "app/runtime.h"

#include <future>

#include "core/log.h"

namespace spherule::app {

Result<std::unique_ptr<Runtime>> Runtime::start(const SceneOptions& scene, const quality::Table& table,
                                                const net::Options& listen) {
    std::promise<Result<void>> ready;  // outlives the thread that keeps it
    std::unique_ptr<Runtime> runtime(new Runtime());
    auto opened = ready.get_future();
    runtime->simulation_ = std::jthread([self = runtime.get(), scene, table, &ready](const std::stop_token& stop) {
        self->simulate(stop, scene, table, ready);
    });
    const Result<void> world = opened.get();
    Result<std::unique_ptr<net::Server>> server = tl::unexpected(Error{});
    if (world) server = net::startServer(listen, runtime->handlers());
    if (world && server) {
        runtime->server_ = std::move(*server);
    } else {
        runtime->simulation_.request_stop();
    }
    runtime->settle();
    if (!world) return tl::unexpected(world.error());
    if (!server) return tl::unexpected(server.error());
    return runtime;
}

void Runtime::settle() {
    settled_ = true;
    settled_.notify_all();
}

Runtime::~Runtime() {
    simulation_.request_stop();
    settle();
    if (simulation_.joinable()) simulation_.join();
}

// The thread that owns the device, for its whole life.
void Runtime::simulate(const std::stop_token& stop, const SceneOptions& scene, const quality::Table& table,
                       std::promise<Result<void>>& ready) {
    auto world = World::open(scene.device, scene.scene, scene.overrides);
    if (!world) {
        ready.set_value(tl::unexpected(world.error()));
        return;
    }
    live_.update([&](LiveReport& report) {
        report.state = "running";
        report.device = (*world)->device().info().kind;
        report.renderer = (*world)->device().info().renderer;
        report.reason = (*world)->device().info().reason;
        report.scene = (*world)->simulation().scene().name;
        report.spheres = (*world)->simulation().count();
    });
    ready.set_value({});
    settled_.wait(false);
    if (stop.stop_requested()) return;
    SimLoop loop(**world, requests_, live_, table, outlets());
    Result<void> ended;
    try {
        ended = loop.run(stop);
    } catch (const std::exception& error) {
        ended = fail(ErrorKind::DeviceLost, "simulation", std::string("ended: ") + error.what());
    }
    if (!ended) {
        failure_ = ended.error();
        failed_ = true;
        live_.update([](LiveReport& report) { report.state = "failed"; });
    }
}

Outlets Runtime::outlets() {
    return {.scene = [this](auto message) { server_->setScene(std::move(message)); },
            .settings = [this](auto message) { server_->setSettings(std::move(message)); },
            .dial = [this](auto message) { server_->setDial(std::move(message)); },
            .everybody = [this](auto message) { server_->broadcast(std::move(message)); },
            .order = [this](auto message) { server_->setOrder(std::move(message)); },
            .frame = [this](const frame::Link& link) { server_->publish(link); },
            .reply = [this](std::uint64_t session, auto result) { server_->reply(session, std::move(result)); },
            .viewers = [this] { return server_->viewers(); },
            .demands = [this] { return server_->demands(); }};
}

net::Handlers Runtime::handlers() {
    return {
        .welcome =
            [this](const v1::Hello&) {
                const LiveReport live = live_.read();
                v1::Welcome welcome;
                welcome.set_server(std::string("spherule ") + SPHERULE_VERSION);
                welcome.set_device(live.device);
                welcome.set_renderer(live.renderer);
                welcome.set_reason(live.reason);
                for (const std::string& name : scene::names()) welcome.add_scenes(name);
                return welcome;
            },
        .submit =
            [this](net::SessionId session, v1::Command command) {
                return requests_.push({session, std::move(command)});
            },
        .get = [this](const std::string& path, const net::Counters& counters) { return site_.get(path, counters); }};
}

std::optional<Error> Runtime::failure() const {
    if (!failed_) return std::nullopt;
    return failure_;
}

void Runtime::drain() {
    live_.update([](LiveReport& report) { report.state = "draining"; });
    v1::ServerMessage message;
    message.mutable_event()->set_kind(v1::Event::DRAINING);
    message.mutable_event()->set_text("The server is stopping.");
    server_->broadcast(std::make_shared<const frame::Message>(std::move(message)));
    simulation_.request_stop();
    if (simulation_.joinable()) simulation_.join();
    while (auto request = requests_.tryPop()) {
        v1::CommandResult result;
        result.set_id(request->command.id());
        result.mutable_refused()->set_reason("the server is stopping");
        server_->reply(request->session, std::move(result));
    }
    server_->drain();
}

}  // namespace spherule::app
