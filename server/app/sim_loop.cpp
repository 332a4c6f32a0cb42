#include "app/sim_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "core/log.h"

namespace spherule::app {

namespace {

using namespace std::chrono_literals;
constexpr auto longestWait = 50ms;  // while paused; a viewer who comes then waits this long for a state
constexpr auto copyWait = 1ms;
constexpr auto reportEvery = 500ms;
constexpr int commandsPerStep = 32;
constexpr std::size_t mostPending = 2;  // copies that a device has under way at once

frame::SharedMessage share(v1::ServerMessage message) {
    return std::make_shared<const frame::Message>(std::move(message));
}

}  // namespace

SimLoop::SimLoop(World& world, BoundedQueue<Request>& requests, Live& live, Outlets outlets)
    : world_(world), requests_(requests), live_(live), outlets_(std::move(outlets)) {}

Result<void> SimLoop::run(const std::stop_token& stop) {
    announce();
    while (!stop.stop_requested()) {
        for (int k = 0; k < commandsPerStep; ++k) {
            auto request = requests_.tryPop();
            if (!request) break;
            serve(*request);
        }
        const auto now = Pacer::Clock::now();
        if (world_.running() && world_.pacer().untilDue(now) == Pacer::Clock::duration{}) {
            if (auto done = step(); !done) return done;
        } else if (auto request = requests_.popFor(patience(now))) {
            serve(*request);
        }
        produce(Pacer::Clock::now());
        collect();
        report();
    }
    return {};
}

Pacer::Clock::duration SimLoop::patience(Pacer::Clock::time_point now) const {
    Pacer::Clock::duration wait = longestWait;
    if (world_.running()) wait = std::min(wait, world_.pacer().untilDue(now));
    if (!pending_.empty()) wait = std::min<Pacer::Clock::duration>(wait, copyWait);
    return wait;
}

void SimLoop::serve(const Request& request) {
    v1::CommandResult result;
    result.set_id(request.command.id());
    try {
        if (auto applied = world_.apply(request.command)) {
            *result.mutable_applied() = std::move(*applied);
        } else {
            result.mutable_refused()->set_field(applied.error().where);
            result.mutable_refused()->set_reason(applied.error().message);
        }
    } catch (const std::bad_alloc&) {
        result.mutable_refused()->set_reason("there is not enough memory for this");
    }
    if (!request.command.has_query() && result.has_applied()) announce();
    outlets_.reply(request.session, std::move(result));
}

// After anything that a command may have changed.
void SimLoop::announce() {
    if (epoch_ != world_.epoch()) {
        epoch_ = world_.epoch();
        pending_.clear();
        measured_ = {};
        outlets_.scene(share(world_.facts()));
    }
    v1::ServerMessage settings = world_.settings();
    if (std::string bytes = settings.SerializeAsString(); bytes != settings_) {
        settings_ = std::move(bytes);
        outlets_.settings(share(std::move(settings)));
    }
    stale_ = true;
    nextState_ = {};
}

Result<void> SimLoop::step() {
    if (auto done = world_.step(); !done) return done;
    world_.pacer().stepped(Pacer::Clock::now());
    stale_ = true;
    for (const std::string& notice : world_.simulation().takeNotices()) warn(notice);
    stopAtNonFinite();
    return {};
}

void SimLoop::warn(const std::string& text) {
    spdlog::warn("{}", text);
    v1::ServerMessage message;
    message.mutable_event()->set_kind(v1::Event::WARNING);
    message.mutable_event()->set_step(world_.simulation().steps());
    message.mutable_event()->set_text(text);
    outlets_.event(share(std::move(message)));
}

void SimLoop::stopAtNonFinite() {
    if (!world_.simulation().counters().nonFinite) return;
    world_.pause();
    v1::ServerMessage message;
    v1::Event& event = *message.mutable_event();
    event.set_kind(v1::Event::NON_FINITE);
    event.set_step(world_.simulation().steps());
    event.set_text(fmt::format("{}. Paused, in the state of the last good step. Use more substeps before you resume.",
                               world_.simulation().divergence()));
    world_.simulation().restore();
    spdlog::error("{}", event.text());
    outlets_.event(share(std::move(message)));
    announce();
}

// Nothing is packed, copied or encoded while nobody watches.
void SimLoop::produce(Pacer::Clock::time_point now) {
    watched_ = outlets_.viewers() > 0;
    if (const std::uint64_t joins = outlets_.joins(); joins != joins_) {
        joins_ = joins;
        stale_ = true;  // whoever came wants to see the world, paused or not
    }
    if (!watched_ || !stale_ || pending_.size() >= mostPending || now < nextState_ || world_.simulation().count() == 0)
        return;
    auto copy = world_.simulation().pack();
    if (!copy) return;
    Pending next;
    next.copy = std::move(copy);
    next.head.set_sequence(++sequence_);
    next.head.set_epoch(epoch_);
    next.head.set_step(world_.simulation().steps());
    next.head.set_sim_time(world_.simulation().time());
    next.head.set_count(world_.simulation().count());
    produced_.push_back(now);
    *next.head.mutable_status() = status(now);
    pending_.push_back(std::move(next));
    stale_ = false;
    const auto interval = std::chrono::duration_cast<Pacer::Clock::duration>(1s) / std::max(outlets_.rate(), 1U);
    nextState_ = std::max(nextState_ + interval, now - interval);
}

void SimLoop::collect() {
    while (!pending_.empty()) {
        const auto bytes = pending_.front().copy->poll();
        if (!bytes) return;
        outlets_.state({std::move(pending_.front().head), {bytes->begin(), bytes->end()}});
        pending_.pop_front();
    }
}

v1::Status SimLoop::status(Pacer::Clock::time_point now) {
    while (!produced_.empty() && now - produced_.front() > 2s) produced_.pop_front();
    v1::Status status;
    if (world_.running()) {
        status.set_real_time_factor(world_.pacer().realTimeFactor(now));
        status.set_steps_per_second(world_.pacer().stepsPerSecond(now));
    }
    if (produced_.size() > 1)
        status.set_frames_per_second(static_cast<double>(produced_.size() - 1) /
                                     std::chrono::duration<double>(now - produced_.front()).count());
    status.set_paused(world_.paused());
    status.set_viewers(outlets_.viewers());
    status.set_sleeping(measured_.sleeping);
    status.set_outside(measured_.outside);
    status.set_non_finite(measured_.nonFinite);
    return status;
}

void SimLoop::report() {
    const auto now = Pacer::Clock::now();
    if (now < nextReport_) return;
    nextReport_ = now + reportEvery;
    if (watched_) measured_ = world_.simulation().statistics();
    const auto times = world_.simulation().passSeconds();
    live_.update([&](LiveReport& report) {
        if (report.state != "draining") report.state = world_.paused() ? "paused" : "running";
        report.scene = world_.simulation().scene().name;
        report.spheres = world_.simulation().count();
        report.steps = world_.simulation().steps();
        report.simSeconds = world_.simulation().time();
        report.rebuilds = world_.simulation().counters().rebuilds;
        report.framesProduced = sequence_;
        report.status = status(now);
        report.passSeconds.resize(std::max(report.passSeconds.size(), times.size()));
        for (std::size_t pass = 0; pass < times.size(); ++pass) report.passSeconds[pass] += times[pass];
    });
}

}  // namespace spherule::app
