// Reports of the simulation thread, besides the states.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/sim_loop.h"
#include "app/to_proto.h"
#include "core/log.h"
#include "core/text.h"

namespace spherule::app {

using namespace std::chrono_literals;

namespace {

constexpr auto reportEvery = 1s;
constexpr auto toldAfter = 250ms;  // a shorter change is not reported
constexpr auto toldEvery = 200ms;
constexpr double slowStepMs = 1000;
constexpr auto interest = 150s;  // figures are measured this long after a request for metrics

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
    broadcast(std::move(message));
}

void SimLoop::tellNotices() {
    for (const std::string& notice : world_.simulation().takeNotices()) say(v1::Event::WARNING, notice);
}

// Sends to viewers and to the recording.
void SimLoop::broadcast(v1::ServerMessage message) {
    const auto shared = codec::share(std::move(message));
    tape_.say(shared);
    outlets_.broadcast(shared);
}

void SimLoop::retain(v1::ServerMessage message) {
    const auto shared = codec::share(std::move(message));
    tape_.retain(shared);
    outlets_.retain(shared);
}

Result<void> SimLoop::roomForTape() {
    return chains_.open(tape_.rendition(), scenery(Pacer::Clock::now())).map_error([](Error error) {
        error.message = "nothing is recorded: " + error.message;
        return error;
    });
}

Result<void> SimLoop::startRecording() {
    if (auto room = roomForTape(); !room) return room;
    return tape_.start();
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
    retain(std::move(message));
}

// Such as "load box-50k is under way (placing spheres, 34 %)".
std::string SimLoop::changeInWords() const {
    const Progress::Seen seen = world_.changeProgress();
    return fmt::format("{} is under way ({}, {:.0f} %)", wordsFor(change_->request.command), seen.doing,
                       100 * seen.share);
}

// Reports the change or the step command under way to viewers, once it has taken `toldAfter`.
void SimLoop::tellOfChange() {
    const auto now = Pacer::Clock::now();
    const Asked* const asked = change_ ? &*change_ : !steps_.empty() ? &steps_.front().asked : nullptr;
    v1::ServerMessage message;
    v1::Change& change = *message.mutable_change();
    if (asked != nullptr) {
        if (now - asked->since < toldAfter || now < nextTold_) return;
        nextTold_ = now + toldEvery;
        change.set_what(wordsFor(asked->request.command));
        change.set_session(asked->request.session);
        if (change_) {
            const Progress::Seen seen = world_.changeProgress();
            change.set_doing(seen.doing);
            change.set_share(seen.share);
        } else {
            const std::uint32_t count = asked->request.command.step().count();
            change.set_doing("stepping");
            change.set_share(static_cast<double>(count - steps_.front().left) / count);
        }
    } else if (!toldOfChange_) {
        return;
    }
    toldOfChange_ = asked != nullptr;
    outlets_.retain(codec::share(std::move(message)));
}

// Why commands or states may be late, for /healthz; empty if they are not.
std::string SimLoop::slowness() const {
    if (change_) return changeInWords();
    if (stepMs_ < slowStepMs || !world_.running()) return "";
    return fmt::format("the step under way has taken {:.1f} s so far, {:.1f} % of it is done", 1e-3 * stepMs_,
                       100 * world_.simulation().shareOfStep());
}

void SimLoop::sendDial() {
    v1::ServerMessage message;
    *message.mutable_dial() = observer_.dial();
    retain(std::move(message));
}

// Finishes the recording, and logs its end: no viewer is notified any more.
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
    broadcast(std::move(message));
}

// Also checks the device: while paused, no step would show that it is lost.
Result<void> SimLoop::report() {
    const auto now = Pacer::Clock::now();
    if (now < nextReport_) return {};
    nextReport_ = now + reportEvery;
    if (auto alive = world_.device().status(); !alive) return alive;
    const auto times = world_.simulation().passSeconds();
    passSeconds_.resize(std::max(passSeconds_.size(), times.size()));
    for (std::size_t pass = 0; pass < times.size(); ++pass) passSeconds_[pass] += times[pass];
    // Figures are measured only between two steps.
    missed_ = world_.simulation().midStep();
    if (!missed_ && (watched_ || live_.askedWithin(interest))) {
        look(std::exchange(passSeconds_, {}));
    } else if (!missed_) {
        passSeconds_.clear();
        seen_.reset();
        observer_.rest();
    }
    live_.update([&](LiveReport& report) {
        report.becomes(world_.paused() ? "paused" : "running");
        report.slow = slowness();
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
