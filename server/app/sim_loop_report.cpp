// What the simulation thread says of itself, beside the states.
#include <fmt/format.h>

#include <algorithm>

#include "app/sim_loop.h"
#include "core/log.h"
#include "core/text.h"

namespace spherule::app {

using namespace std::chrono_literals;

namespace {

constexpr auto reportEvery = 1s;
constexpr auto interest = 150s;  // in figures, after somebody asked for metrics

}  // namespace

void SimLoop::say(v1::Event::Kind kind, const std::string& text) {
    const auto level = kind == v1::Event::TUNED     ? spdlog::level::info
                       : kind == v1::Event::WARNING ? spdlog::level::warn
                                                    : spdlog::level::err;
    spdlog::log(level, "{}", text);
    v1::ServerMessage message;
    message.mutable_event()->set_kind(kind);
    message.mutable_event()->set_step(world_.simulation().steps());
    message.mutable_event()->set_text(utf8(text));
    everybody(std::move(message));
}

// For viewers, and for the recording.
void SimLoop::everybody(v1::ServerMessage message) {
    const auto shared = frame::share(std::move(message));
    tape_.say(shared);
    outlets_.everybody(shared);
}

void SimLoop::keep(v1::ServerMessage message) {
    const auto shared = frame::share(std::move(message));
    tape_.keep(shared);
    outlets_.keep(shared);
}

void SimLoop::tellOfTape() {
    if (!tape_.canRecord()) return;
    const auto news = tape_.news(Tape::Clock::now());
    if (!news) return;
    live_.update([&](LiveReport& report) { report.recording = *news; });
    if (!news->failure().empty())
        say(v1::Event::WARNING, fmt::format("The recording {} has ended: {}.", news->file(), news->failure()));
    v1::ServerMessage message;
    *message.mutable_recording() = *news;
    keep(std::move(message));
}

void SimLoop::sendDial() {
    v1::ServerMessage message;
    *message.mutable_dial() = observer_.dial();
    keep(std::move(message));
}

// At the end nobody else tells of it.
Result<void> SimLoop::finishTape() {
    const auto last = tape_.finish();
    if (!last) return {};
    if (!last->failure().empty()) return fail(ErrorKind::Refused, last->file(), last->failure());
    spdlog::info("recorded {:.1f} s in {}, {:.1f} MB", last->duration(), last->file(),
                 static_cast<double>(last->bytes()) / 1e6);
    return {};
}

v1::Status SimLoop::status(Pacer::Clock::time_point now) {
    v1::Status status;
    if (world_.running()) {
        status.set_real_time_factor(world_.pacer().realTimeFactor(now));
        status.set_steps_per_second(world_.pacer().stepsPerSecond(now));
    }
    status.set_frames_per_second(states_.perSecond(now));
    status.set_paused(world_.paused());
    status.set_viewers(outlets_.viewers());
    if (seen_) {
        status.set_sleeping(seen_->statistics().sleeping());
        status.set_outside(seen_->statistics().outside());
        status.set_non_finite(seen_->statistics().non_finite());
    }
    return status;
}

void SimLoop::look(const std::vector<double>& passSeconds) {
    Observer::Sight sight = observer_.look(world_.simulation(), passSeconds);
    for (const std::string& alarm : sight.alarms) say(v1::Event::WARNING, alarm);
    if (sight.dialMoved) sendDial();
    seen_ = std::move(sight.diagnostics);
    v1::ServerMessage message;
    *message.mutable_diagnostics() = *seen_;
    everybody(std::move(message));
}

// Also while it is paused, and no step tells, the device may be lost.
Result<void> SimLoop::report() {
    const auto now = Pacer::Clock::now();
    if (now < nextReport_) return {};
    nextReport_ = now + reportEvery;
    if (auto alive = world_.device().status(); !alive) return alive;
    const auto times = world_.simulation().passSeconds();
    if (watched_ || live_.askedWithin(interest)) {
        look(times);
    } else {
        seen_.reset();
        observer_.rest();
    }
    live_.update([&](LiveReport& report) {
        report.becomes(world_.paused() ? "paused" : "running");
        report.scene = world_.simulation().scene().name;
        report.spheres = world_.simulation().count();
        report.steps = world_.simulation().steps();
        report.simSeconds = world_.simulation().time();
        report.rebuilds = world_.simulation().counters().rebuilds;
        report.framesProduced = chains_.made();
        report.recordingFramesLost = tape_.framesLost();
        report.status = status(now);
        report.diagnostics = seen_;
        report.passSeconds.resize(std::max(report.passSeconds.size(), times.size()));
        for (std::size_t pass = 0; pass < times.size(); ++pass) report.passSeconds[pass] += times[pass];
    });
    return {};
}

}  // namespace spherule::app
