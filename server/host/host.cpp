#include "host/host.h"

#include <pthread.h>

#include <fmt/format.h>

#include <new>
#include <utility>

#include "core/heartbeat.h"
#include "core/text.h"
#include "host/to_proto.h"

namespace spherule::host {

namespace {

using namespace std::chrono_literals;
constexpr auto longestWaitForEnd = 10s;          // for the current step and the recording
constexpr auto longestWaitForCheckpoint = 120s;  // beyond it, for the last checkpoint

}  // namespace

Host::Host(Watchdog::Seconds watchdogLimit, PrintError printError)
    : watchdog_(watchdogLimit), routes_(board_, watchdog_), printError_(std::move(printError)) {}

Result<std::unique_ptr<Host>> Host::start(const ProducerFactory& create, const net::Options& listen,
                                          Watchdog::Seconds watchdogLimit, PrintError printError) {
    std::unique_ptr<Host> host(new Host(watchdogLimit, std::move(printError)));
    auto server = net::startServer(listen, host->handlers());
    if (!server) return tl::unexpected(server.error());
    host->server_ = std::move(*server);
    host->watchdog_.start([self = host.get()](const Error& error) { self->hung(error); });
    host->thread_ =
        std::jthread([self = host.get(), create](const std::stop_token& stop) { self->runThread(stop, create); });
    return host;
}

Host::~Host() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
    watchdog_.stop();
}

// Runs on the thread that creates, uses and destroys the device.
void Host::runThread(const std::stop_token& stop, const ProducerFactory& create) {
    pthread_setname_np(pthread_self(), "simulation");
    Result<void> done;
    try {
        done = run(stop, create);
    } catch (const std::bad_alloc&) {
        done = fail(opened() ? ErrorKind::DeviceLost : ErrorKind::Refused, "memory",
                    "there is not enough for this scene; use fewer spheres, or give the program more");
    } catch (const std::exception& error) {
        done = fail(ErrorKind::DeviceLost, "simulation", std::string("ended: ") + error.what());
    }
    if (done || done.error().kind != ErrorKind::DeviceLost) producer_.reset();
    const std::lock_guard lock(mutex_);
    if (!done) failure_ = done.error();
    ended_ = true;
    changed_.notify_all();
}

Result<void> Host::run(const std::stop_token& stop, const ProducerFactory& create) {
    auto producer = create({requests_, board_, *server_, saver_});
    if (!producer) return tl::unexpected(producer.error());
    producer_ = std::move(*producer);
    board_.update([](ServerStatus& current) { current.setState("running"); });
    {
        const std::lock_guard lock(mutex_);
        opened_ = true;
    }
    return producer_->run(stop);
}

bool Host::opened() const {
    const std::lock_guard lock(mutex_);
    return opened_;
}

std::optional<Error> Host::failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
}

net::Handlers Host::handlers() {
    return {
        .welcome =
            [this](const v1::Hello&) {
                const ServerStatus status = board_.read();
                v1::Welcome welcome = welcomeOf(status.device);
                for (const std::string& name : status.scenes) welcome.add_scenes(name);
                for (const scene::CatalogEntry& entry : status.catalog) {
                    v1::SceneEntry& shown = *welcome.add_gallery();
                    shown.set_name(entry.name);
                    shown.set_description(entry.description);
                    shown.set_what_to_try(entry.whatToTry);
                    shown.set_spheres(entry.spheres);
                }
                return welcome;
            },
        .submit =
            [this](net::SessionId session, v1::Command command, std::size_t cost) {
                return requests_.push({.session = session, .command = std::move(command), .bytes = cost});
            },
        .mayNotCommand = [this](net::SessionId session) { requests_.release(session); },
        .refuses = [this](net::SessionId session, std::size_t cost) { return requests_.refuses(session, cost); },
        .ready = [this] { return opened(); },
        .file = [this](const std::string& path) { return routes_.file(path); },
        .download = [this](const std::string& path) { return routes_.download(path); },
        .saveScene = [this](SceneSaver::Made made) { saver_.ask(std::move(made)); },
        .get = [this](const std::string& path, const net::Counters& counters) { return routes_.get(path, counters); }};
}

bool Host::drain() {
    beginShutdown(failure());
    thread_.request_stop();
    std::unique_lock lock(mutex_);
    bool ended = changed_.wait_for(lock, longestWaitForEnd, [this] { return ended_; });
    const auto checkpoints = board_.read().checkpoints;
    if (!ended && checkpoints) ended = changed_.wait_for(lock, longestWaitForCheckpoint, [this] { return ended_; });
    const bool lost = failure_ && failure_->kind == ErrorKind::DeviceLost;
    lock.unlock();
    const heartbeat::Pause leaving;  // the producer has ended, so no beats are expected
    refuseWaiting();
    server_->drain();
    return ended && !lost;
}

// Called on the watchdog's thread. The recording is not finished, but its file can be played.
void Host::hung(const Error& error) {
    const int exitCode = printError_(error);
    beginShutdown(error);
    server_->drain();
    endNow(exitCode);
}

void Host::beginShutdown(const std::optional<Error>& failure) {
    board_.update([&](ServerStatus& current) { current.state = failure ? "failed" : "draining"; });
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

void Host::refuseWaiting() {
    const auto refuse = [this](const Request& request) {
        const Error error{ErrorKind::Refused, "", "the server is stopping", Cause::Stopping};
        server_->reply(request.session, resultOf(request.command, tl::unexpected(error)));
    };
    while (const auto request = requests_.tryPop()) refuse(*request);
    for (const Request& query : requests_.takeQueries()) refuse(query);
}

}  // namespace spherule::host
