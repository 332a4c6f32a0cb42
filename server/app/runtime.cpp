#include "app/runtime.h"

#include <pthread.h>

#include <fmt/format.h>

#include <new>

#include "app/options.h"
#include "app/to_proto.h"
#include "core/heartbeat.h"
#include "core/text.h"

namespace spherule::app {

namespace {

using namespace std::chrono_literals;
constexpr auto stepPatience = 10s;  // longest wait for the current step and the recording when the show ends

}  // namespace

Runtime::Runtime(Watchdog::Seconds patience) : watchdog_(patience), site_(live_, watchdog_) {}

Result<std::unique_ptr<Runtime>> Runtime::start(const OpenShow& open, const net::Options& listen,
                                                Watchdog::Seconds patience) {
    std::unique_ptr<Runtime> runtime(new Runtime(patience));
    auto server = net::startServer(listen, runtime->handlers());
    if (!server) return tl::unexpected(server.error());
    runtime->server_ = std::move(*server);
    runtime->watchdog_.start([self = runtime.get()](const Error& error) { self->hung(error); });
    runtime->thread_ =
        std::jthread([self = runtime.get(), open](const std::stop_token& stop) { self->present(stop, open); });
    return runtime;
}

Runtime::~Runtime() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
    watchdog_.stop();
}

// Runs on the thread that creates, uses and destroys the device.
void Runtime::present(const std::stop_token& stop, const OpenShow& open) {
    pthread_setname_np(pthread_self(), "simulation");
    Result<void> done;
    try {
        done = run(stop, open);
    } catch (const std::bad_alloc&) {
        done = fail(opened() ? ErrorKind::DeviceLost : ErrorKind::Refused, "memory",
                    "there is not enough for this scene; use fewer spheres, or give the program more");
    } catch (const std::exception& error) {
        done = fail(ErrorKind::DeviceLost, "simulation", std::string("ended: ") + error.what());
    }
    if (done || done.error().kind != ErrorKind::DeviceLost) show_.reset();
    const std::lock_guard lock(mutex_);
    if (!done) failure_ = done.error();
    ended_ = true;
    changed_.notify_all();
}

Result<void> Runtime::run(const std::stop_token& stop, const OpenShow& open) {
    auto show = open({requests_, live_, outlets()});
    if (!show) return tl::unexpected(show.error());
    show_ = std::move(*show);
    live_.update([](LiveReport& report) { report.becomes("running"); });
    {
        const std::lock_guard lock(mutex_);
        opened_ = true;
    }
    return show_->run(stop);
}

bool Runtime::opened() const {
    const std::lock_guard lock(mutex_);
    return opened_;
}

std::optional<Error> Runtime::failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
}

Outlets Runtime::outlets() {
    return {.retain = [this](auto message) { server_->retain(std::move(message)); },
            .broadcast = [this](auto message) { server_->broadcast(std::move(message)); },
            .order = [this](auto message) { server_->setOrder(std::move(message)); },
            .frame = [this](const codec::EncodedFrame& encoded) { server_->publish(encoded); },
            .reply = [this](std::uint64_t session, auto result) { server_->reply(session, std::move(result)); },
            .viewers = [this] { return server_->viewers(); },
            .subscriptions = [this] { return server_->subscriptions(); }};
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
            [this](net::SessionId session, v1::Command command, std::size_t cost) {
                return requests_.push({.session = session, .command = std::move(command), .bytes = cost});
            },
        .refuses = [this](net::SessionId session, std::size_t cost) { return requests_.refuses(session, cost); },
        .ready = [this] { return opened(); },
        .get = [this](const std::string& path, const net::Counters& counters) { return site_.get(path, counters); }};
}

bool Runtime::drain() {
    beginToEnd(failure());
    thread_.request_stop();
    std::unique_lock lock(mutex_);
    const bool ended = changed_.wait_for(lock, stepPatience, [this] { return ended_; });
    const bool lost = failure_ && failure_->kind == ErrorKind::DeviceLost;
    lock.unlock();
    const heartbeat::Pause leaving;  // the show has ended, so no beats are expected
    refuseWaiting();
    server_->drain();
    return ended && !lost;
}

// Called on the watchdog's thread. The recording is not finished, but its file can be played.
void Runtime::hung(const Error& error) {
    const int exitCode = app::report(error);
    beginToEnd(error);
    server_->drain();
    endNow(exitCode);
}

void Runtime::beginToEnd(const std::optional<Error>& failure) {
    live_.update([&](LiveReport& report) { report.state = failure ? "failed" : "draining"; });
    server_->stopAccepting();
    v1::ServerMessage message;
    v1::Event& event = *message.mutable_event();
    const bool lost = failure && failure->kind == ErrorKind::DeviceLost;
    event.set_kind(lost ? v1::Event::DEVICE_LOST : v1::Event::DRAINING);
    event.set_text(failure ? utf8(fmt::format("The simulation has ended ({}): this page goes on by itself once the "
                                              "server has been started again.",
                                              failure->text()))
                           : "The server is stopping.");
    server_->broadcast(codec::share(std::move(message)));
}

void Runtime::refuseWaiting() {
    const auto refuse = [this](const Request& request) {
        const Error error{ErrorKind::Refused, "", "the server is stopping"};
        server_->reply(request.session, resultOf(request.command, tl::unexpected(error)));
    };
    while (const auto request = requests_.tryPop()) refuse(*request);
    for (const Request& query : requests_.takeQueries()) refuse(query);
}

}  // namespace spherule::app
