#include "app/runtime.h"

#include <future>

#include "app/facts.h"

namespace spherule::app {

Result<std::unique_ptr<Runtime>> Runtime::start(const OpenShow& open, const net::Options& listen) {
    std::promise<Result<void>> ready;  // outlives the thread that keeps it
    std::unique_ptr<Runtime> runtime(new Runtime());
    auto opened = ready.get_future();
    runtime->show_ = std::jthread(
        [self = runtime.get(), open, &ready](const std::stop_token& stop) { self->present(stop, open, ready); });
    const Result<void> show = opened.get();
    Result<std::unique_ptr<net::Server>> server = tl::unexpected(Error{});
    if (show) server = net::startServer(listen, runtime->handlers());
    if (show && server) {
        runtime->server_ = std::move(*server);
    } else {
        runtime->show_.request_stop();
    }
    runtime->settle();
    if (!show) return tl::unexpected(show.error());
    if (!server) return tl::unexpected(server.error());
    return runtime;
}

void Runtime::settle() {
    settled_ = true;
    settled_.notify_all();
}

Runtime::~Runtime() {
    show_.request_stop();
    settle();
    if (show_.joinable()) show_.join();
}

namespace {

// What is not expected to go wrong, such as a lack of memory, as an error.
template <class Act>
auto guarded(Act act) -> decltype(act()) {
    try {
        return act();
    } catch (const std::exception& error) {
        return fail(ErrorKind::DeviceLost, "simulation", std::string("ended: ") + error.what());
    }
}

}  // namespace

// The thread that owns the device, for its whole life.
void Runtime::present(const std::stop_token& stop, const OpenShow& open, std::promise<Result<void>>& ready) {
    const auto show = guarded([&] { return open({requests_, live_, outlets()}); });
    if (!show) {
        ready.set_value(tl::unexpected(show.error()));
        return;
    }
    ready.set_value({});
    settled_.wait(false);
    if (stop.stop_requested()) return;
    const Result<void> ended = guarded([&] { return (*show)->run(stop); });
    if (!ended) {
        failure_ = ended.error();
        failed_ = true;
        live_.update([](LiveReport& report) { report.state = "failed"; });
    }
}

Outlets Runtime::outlets() {
    return {.keep = [this](auto message) { server_->keep(std::move(message)); },
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
                v1::Welcome welcome = welcomeOf(live.device);
                for (const std::string& name : live.scenes) welcome.add_scenes(name);
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
    show_.request_stop();
    if (show_.joinable()) show_.join();
    while (auto request = requests_.tryPop()) {
        v1::CommandResult result;
        result.set_id(request->command.id());
        result.mutable_refused()->set_reason("the server is stopping");
        server_->reply(request->session, std::move(result));
    }
    server_->drain();
}

}  // namespace spherule::app
