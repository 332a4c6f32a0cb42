#include "host/simulation_producer.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/heartbeat.h"
#include "core/log.h"
#include "core/text.h"
#include "host/facts_message.h"
#include "host/to_proto.h"

namespace spherule::host {

namespace {

using namespace std::chrono_literals;
constexpr auto longestWait = 50ms;  // longest wait of a new viewer for a state while paused
// A step up to this long is done as a whole. Commands are served between the substeps of a longer step.
constexpr auto wholeStep = 100ms;
constexpr auto sliceOfStep = 20ms;
constexpr auto sliceOfChange = 5ms;  // at least; as long as the step of the same turn, if there is one
constexpr auto reportEvery = 1s;
constexpr auto reportChangeAfter = 250ms;  // a shorter change is not reported
constexpr auto reportChangeEvery = 200ms;
constexpr double slowStepMs = 1000;
constexpr auto measureAfterRead = 150s;  // figures are measured this long after a request for metrics

}  // namespace

SimulationProducer::SimulationProducer(std::unique_ptr<SimulationHost> host, const ProducerIo& io,
                                       diagnostics::Table table, recording::LiveOptions recordings,
                                       std::unique_ptr<SceneWatch> watch, std::unique_ptr<checkpoint::Keeper> keeper)
    : owned_(std::move(host)),
      host_(*owned_),
      board_(io.board),
      publisher_(io.publisher),
      saver_(io.saver),
      keeper_(keeper ? std::move(keeper) : checkpoint::Keeper::open({}).value()),
      watch_(std::move(watch)),
      recorder_(std::move(recordings), welcomeOf(host_.device().info())),
      streams_(
          host_, publisher_, recorder_, [this] { frameRate_.add(version_, Clock::now()); },
          [this](const std::string& text) { notify(v1::Event::WARNING, text); }),
      sampler_(std::move(table)),
      commands_(host_, io.requests, publisher_, *this) {}

Result<void> SimulationProducer::run(const std::stop_token& stop) {
    if (auto done = resume(); !done) return done;
    publishChanges();
    if (host_.resumed()) savedVersion_ = version_;
    if (recorder_.startsAtOnce())
        if (auto room = reserveEncoder(); !room) return room;
    if (auto done = recorder_.startFromOptions(); !done) return done;
    saver_.open();
    const Result<void> done = simulate(stop);
    saver_.close();
    if (done)
        keeper_->endLogInRecording(host_.simulation());
    else
        keeper_->dropLogInRecording();
    const Result<void> finished = finishRecording();
    if (done) finishState();
    return done ? finished : done;
}

Result<void> SimulationProducer::simulate(const std::stop_token& stop) {
    Result<void> done;
    while (done && !stop.stop_requested()) {
        heartbeat::beat("serving viewers");
        commands_.serveWaiting();
        reloadWhenSaved();
        const bool worked = advance(done);
        if (!done) break;
        commands_.answerQueries();
        saver_.serve(host_.simulation());
        keepState(Clock::now());
        reportChange();
        reportWhenStopped();
        done = report();
        produce(Clock::now());
        reportRecording();
        if (worked) continue;
        commands_.serveNext(waitTime(Clock::now()));
    }
    commands_.refuseAll("the server is stopping", Cause::Stopping);
    return done;
}

// Loads the scene again when its file, or a file that it names, has been saved. Tells when one is gone.
void SimulationProducer::reloadWhenSaved() {
    const auto change = watch_ && !host_.changing() ? watch_->takeChange() : std::nullopt;
    if (!change) return;
    for (const std::string& file : change->gone) notify(v1::Event::WARNING, watch_->goneText(file));
    const auto saved = watch_->savedToLoad(*change);
    if (!saved) return;
    spdlog::info("{} has been saved: loading {}", *saved, watch_->path());
    saved_ = *saved;
    commands_.reload(watch_->name(), watch_->load(host_.device().info().kind, host_.overrides()));
}

void SimulationProducer::reloaded(const Result<sim::Applied>& done) {
    if (done)
        spdlog::info("{} is loaded", watch_->path());
    else
        notify(v1::Event::WARNING, watch_->failureText(saved_, done.error()));
}

// Does a part of the step under way and of the change under way. Returns false when there is neither.
bool SimulationProducer::advance(Result<void>& done) {
    const auto start = Clock::now();
    bool due = host_.running() && host_.scheduler().untilDue(start) == Clock::duration{};
    // A checkpoint waits for the end of the step.
    due = due || (host_.simulation().midStep() && !host_.changing() && wantsCheckpoint(start));
    if (due) done = advanceStep(start);
    if (!done || !host_.changing()) return due;
    commands_.advanceChange(std::max<Clock::duration>(sliceOfChange, Clock::now() - start));
    return true;
}

SimulationProducer::Clock::duration SimulationProducer::waitTime(Clock::time_point now) const {
    Clock::duration wait = longestWait;
    if (host_.running()) wait = std::min(wait, host_.scheduler().untilDue(now));
    if (const auto due = commands_.due()) wait = std::min(wait, std::max(*due - now, Clock::duration{}));
    if (const auto due = streams_.due()) wait = std::min(wait, std::max(*due - now, Clock::duration{}));
    return wait;
}

void SimulationProducer::worldChanged() {
    reportNotices();
    substepController_.reset();
    sampler_.invalidateBaseline();
    nextReport_ = {};  // measures the energy at the start, before steps change it
    if (!host_.simulation().midStep()) stepMs_ = 0;
}

// Sends the scene facts, settings and dial that have changed. Call after any change.
void SimulationProducer::publishChanges() {
    commands_.discardAnswer();
    host_.noticeGeneration();
    if (world_ != host_.epoch()) {
        world_ = host_.epoch();
        diagnostics_.reset();
        streams_.beginWorld();
    }
    v1::ServerMessage settings = host_.settings();
    if (std::string bytes = settings.SerializeAsString(); bytes != settings_) {
        settings_ = std::move(bytes);
        retain(std::move(settings));
    }
    sendParts();
    if (sampler_.updateDial(host_.simulation(), world_)) sendDial();
    ++version_;
}

// Advances the step under way, or the next one, until it ends or commands must be served.
Result<void> SimulationProducer::advanceStep(Clock::time_point now) {
    const auto slice = host_.simulation().midStep() ? sliceOfStep : wholeStep;
    const auto ended = host_.advance(now + slice);
    const auto end = Clock::now();
    stepMs_ += std::chrono::duration<double, std::milli>(end - now).count();
    if (!ended) return tl::unexpected(ended.error());
    if (!*ended) return {};
    if (std::exchange(reportMissed_, false)) nextReport_ = {};
    const double wallMs = std::exchange(stepMs_, 0);
    host_.scheduler().stepped(end);
    sampler_.addStep(wallMs);
    ++version_;
    // Sinks have taken energy with the spheres.
    const std::uint64_t population = host_.simulation().population().version();
    if (population != std::exchange(population_, population)) sampler_.invalidateBaseline();
    // Springs of users, obstacles and media that move, and borders of fields do work on spheres.
    const scene::Scene& scene = host_.simulation().scene();
    if (host_.simulation().pulling() || scene::anyMoves(scene.obstacles) || scene.forces.addEnergy())
        sampler_.invalidateBaseline();
    if (host_.paused()) commands_.discardAnswer();
    reportNotices();
    stopAtNonFinite();
    commands_.countStep();
    if (auto done = tune(wallMs); !done) return done;
    keeper_->logStep(host_.simulation());
    return {};
}

Result<void> SimulationProducer::tune(double wallMs) {
    sim::Simulation& simulation = host_.simulation();
    const std::uint32_t before = simulation.scene().quality.substeps;
    auto message = substepController_.stepped(simulation, wallMs);
    if (!message) return tl::unexpected(message.error());
    const std::uint32_t chosen = simulation.scene().quality.substeps;
    if (chosen != before) keeper_->logSubsteps(checkpoint::placeOf(simulation), chosen);
    if (!*message) return {};
    notify(v1::Event::TUNED, **message);
    publishChanges();
    return {};
}

void SimulationProducer::stopAtNonFinite() {
    if (!host_.simulation().counters().nonFinite) return;
    host_.pause();
    notify(v1::Event::NON_FINITE,
           fmt::format("{}. Paused, in the state of the last good step. Use more substeps before you resume.",
                       host_.simulation().divergence()));
    commands_.refuseSteps("a position or velocity became non-finite", Cause::NonFinite);
    keeper_->logRollback(checkpoint::placeOf(host_.simulation()));
    host_.simulation().rollback();
    sampler_.invalidateBaseline();
    publishChanges();
}

// Makes a report due when the world has stopped, before the frame of this state is produced. The status of that frame
// then belongs to this state.
void SimulationProducer::reportWhenStopped() {
    watched_ = !publisher_.subscriptions().empty();
    if (host_.running() || !watched_ || host_.simulation().midStep()) return;
    if (!diagnostics_ || diagnostics_->statistics().step() != host_.simulation().steps()) nextReport_ = {};
}

void SimulationProducer::produce(Clock::time_point now) {
    streams_.produce(moment(now), publisher_.subscriptions(), now);
}

StateStreams::Moment SimulationProducer::moment(Clock::time_point now) {
    return {.version = version_, .head = [this, now] { return head(now); }};
}

v1::Frame SimulationProducer::head(Clock::time_point now) {
    v1::Frame head;
    head.set_step(host_.simulation().steps());
    head.set_sim_time(host_.simulation().time());
    setPoses(head, host_.simulation().scene().obstacles, host_.simulation().time());
    *head.mutable_status() = status(now);
    return head;
}

void SimulationProducer::notify(v1::Event::Kind kind, const std::string& text) {
    const auto level = kind == v1::Event::TUNED     ? spdlog::level::info
                       : kind == v1::Event::WARNING ? spdlog::level::warn
                                                    : spdlog::level::err;
    spdlog::log(level, "{}", text);
    v1::ServerMessage message;
    message.mutable_event()->set_kind(kind);
    message.mutable_event()->set_step(host_.simulation().steps());
    message.mutable_event()->set_text(utf8(text));
    broadcast(std::move(message));
}

void SimulationProducer::reportNotices() {
    for (const std::string& notice : host_.simulation().takeNotices()) notify(v1::Event::WARNING, notice);
}

// Sends to viewers and to the recording.
void SimulationProducer::broadcast(v1::ServerMessage message) {
    const auto shared = codec::share(std::move(message));
    recorder_.broadcast(shared);
    publisher_.broadcast(shared);
}

void SimulationProducer::retain(v1::ServerMessage message) {
    const auto shared = codec::share(std::move(message));
    recorder_.retain(shared);
    publisher_.retain(shared);
}

// Reports the change or the step command under way to viewers, once it has taken `reportChangeAfter`.
void SimulationProducer::reportChange() {
    const auto now = Clock::now();
    const auto activity = commands_.activity();
    v1::ServerMessage message;
    v1::Change& change = *message.mutable_change();
    if (activity) {
        if (now - activity->since < reportChangeAfter || now < nextChangeReport_) return;
        nextChangeReport_ = now + reportChangeEvery;
        change.set_what(wordsFor(activity->request.command));
        change.set_session(activity->request.session);
        change.set_doing(activity->doing);
        change.set_share(activity->share);
    } else if (!changeReported_) {
        return;
    }
    changeReported_ = activity.has_value();
    publisher_.retain(codec::share(std::move(message)));
}

// Why commands or states may be late, for /healthz; empty if they are not.
std::string SimulationProducer::slowness() const {
    if (host_.changing()) return commands_.changeInWords();
    if (stepMs_ < slowStepMs || !host_.running()) return "";
    return fmt::format("the step under way has taken {:.1f} s so far, {:.1f} % of it is done", 1e-3 * stepMs_,
                       100 * host_.simulation().shareOfStep());
}

// Sends the fields, emitters and materials if they have changed.
void SimulationProducer::sendParts() {
    const Parts present{host_.epoch(), host_.simulation().partsVersion()};
    if (std::exchange(parts_, present) == present) return;
    v1::ServerMessage message = partsMessage(host_.simulation().scene());
    std::string bytes = message.SerializeAsString();
    if (bytes == partsBytes_) return;
    partsBytes_ = std::move(bytes);
    publisher_.retain(codec::share(std::move(message)));
}

void SimulationProducer::sendDial() {
    v1::ServerMessage message;
    *message.mutable_dial() = sampler_.dial();
    retain(std::move(message));
}

v1::Status SimulationProducer::status(Clock::time_point now) {
    v1::Status status;
    if (host_.running()) {
        status.set_real_time_factor(host_.scheduler().realTimeFactor(now));
        status.set_steps_per_second(host_.scheduler().stepsPerSecond(now));
    }
    status.set_frames_per_second(frameRate_.perSecond(now));
    status.set_paused(host_.paused());
    status.set_viewers(publisher_.viewers());
    if (diagnostics_) {
        status.set_sleeping(diagnostics_->statistics().sleeping());
        status.set_outside(diagnostics_->statistics().outside());
        status.set_non_finite(diagnostics_->statistics().non_finite());
    }
    return status;
}

void SimulationProducer::sampleDiagnostics(const std::vector<double>& passSeconds) {
    DiagnosticsSampler::Sample sample = sampler_.sample(host_.simulation(), passSeconds);
    for (const std::string& alarm : sample.alarms) notify(v1::Event::WARNING, alarm);
    if (sample.dialChanged) sendDial();
    diagnostics_ = std::move(sample.diagnostics);
    v1::ServerMessage message;
    *message.mutable_diagnostics() = *diagnostics_;
    broadcast(std::move(message));
}

// Also checks the device: while paused, no step would show that it is lost.
Result<void> SimulationProducer::report() {
    const auto now = Clock::now();
    if (now < nextReport_) return {};
    nextReport_ = now + reportEvery;
    if (auto alive = host_.device().status(); !alive) return alive;
    const auto times = host_.simulation().passSeconds();
    passSeconds_.resize(std::max(passSeconds_.size(), times.size()));
    for (std::size_t pass = 0; pass < times.size(); ++pass) passSeconds_[pass] += times[pass];
    // Figures are measured only between two steps.
    reportMissed_ = host_.simulation().midStep();
    const bool measures = watched_ || board_.readWithin(measureAfterRead);
    host_.device().useTimers(measures);
    const bool timed = std::exchange(timed_, measures);  // since the last report
    if (!timed) passSeconds_.clear();
    if (!reportMissed_ && measures) {
        sampleDiagnostics(std::exchange(passSeconds_, {}));
    } else if (!reportMissed_) {
        passSeconds_.clear();
        diagnostics_.reset();
        sampler_.discard();
    }
    board_.update([&](ServerStatus& current) {
        current.setState(host_.paused() ? "paused" : "running");
        current.slow = slowness();
        current.scene = host_.simulation().scene().name;
        current.spheres = host_.simulation().count();
        current.steps = host_.simulation().steps();
        current.simSeconds = host_.simulation().time();
        current.rebuilds = host_.simulation().counters().rebuilds;
        current.framesProduced = streams_.framesMade();
        current.born = host_.simulation().population().born();
        current.removed = host_.simulation().population().removed();
        current.recordingFramesLost = recorder_.framesLost();
        current.status = status(now);
        current.diagnostics = diagnostics_;
        current.passSeconds.resize(std::max(current.passSeconds.size(), times.size()));
        for (std::size_t pass = 0; pass < times.size(); ++pass) current.passSeconds[pass] += times[pass];
    });
    return {};
}

}  // namespace spherule::host
