// The part of SimulationProducer that writes files: checkpoints, the command log and recordings.
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/archive.h"
#include "core/heartbeat.h"
#include "core/log.h"
#include "host/resume.h"
#include "host/simulation_producer.h"

namespace spherule::host {

namespace {

using namespace std::chrono_literals;
constexpr auto shortestPause = 1s;     // between checkpoints that commands ask for
constexpr auto longestLastStep = 60s;  // for the rest of the step at the end
constexpr double megabyte = 1e6;

}  // namespace

// Goes on from the checkpoint, if there is one, and begins the log.
Result<void> SimulationProducer::resume() {
    sim::Simulation& simulation = host_.simulation();
    const auto& resumed = host_.resumed();
    if (resumed) {
        Loader tuning(resumed->head.tuning());
        substepController_.archive(tuning);
        if (!tuning.ok()) substepController_.reset();
        reportResumed(resumed->path, simulation, host_.sceneAsked());
    }
    if (keeper_->hasFolder())
        board_.update([](ServerStatus& current) {
            current.checkpoints.emplace(ServerStatus::Checkpoints{.safeAt = Clock::now()});
        });
    if (auto done = keeper_->beginLog(simulation, stateHead(), resumed ? &*resumed : nullptr); !done) return done;
    releasePulls(simulation, *keeper_);
    return {};
}

v1::StateHead SimulationProducer::stateHead() {
    v1::StateHead head = host_.stateHead();
    Saver tuning;
    substepController_.archive(tuning);
    head.set_tuning(tuning.take());
    return head;
}

void SimulationProducer::carriedOut(const checkpoint::Keeper::Place& at, const Request& request) {
    if (request.command.has_load())
        keeper_->logWorld(at, host_.simulation(), stateHead());
    else
        keeper_->logCommand(at, request.session, request.command);
}

Result<void> SimulationProducer::checkCheckpoints() {
    if (keeper_->hasFolder()) return {};
    return fail(ErrorKind::Refused, "", "this server writes no checkpoints: start it with --checkpoints FOLDER",
                Cause::NoCheckpoints);
}

// Returns true if a checkpoint should be written now.
bool SimulationProducer::wantsCheckpoint(Clock::time_point now) const {
    if (!keeper_->hasFolder() || keeper_->saving()) return false;
    if (commands_.asksForCheckpoint() && now - savedAt_ >= shortestPause) return true;
    return keeper_->due(now) && savedVersion_ != version_;
}

// Writes a checkpoint if one is due or asked for, at the end of a step.
void SimulationProducer::keepState(Clock::time_point now) {
    reportCheckpoints();
    keeper_->flushLogs(now);
    beginLogInRecording();
    if (wantsCheckpoint(now) && !host_.simulation().midStep()) saveState(now);
}

void SimulationProducer::saveState(Clock::time_point now) {
    commands_.checkpointBegun();
    savedAt_ = now;
    const auto begun = keeper_->save(host_.simulation(), stateHead(), now);
    if (begun) {
        savedVersion_ = version_;
        return;
    }
    notify(v1::Event::WARNING, fmt::format("no checkpoint could be written: {}", begun.error().text()));
    board_.update([](ServerStatus& current) { ++current.checkpoints->failed; });
    commands_.answerCheckpoints(host_.simulation().steps(), tl::unexpected(begun.error()));
}

void SimulationProducer::reportCheckpoints() {
    for (const Error& failure : keeper_->takeLogFailures())
        notify(v1::Event::WARNING, fmt::format("the command log has ended: {}", failure.text()));
    for (const checkpoint::Keeper::Outcome& outcome : keeper_->takeOutcomes()) {
        board_.update([&](ServerStatus& current) {
            ServerStatus::Checkpoints& checkpoints = *current.checkpoints;
            ++(outcome.written ? checkpoints.written : checkpoints.failed);
            if (!outcome.written) return;
            checkpoints.bytes = outcome.written->bytes;
            checkpoints.safeAt = savedAt_;
        });
        if (!outcome.written) {
            savedVersion_ = notSaved;
            Error error = outcome.written.error();
            notify(v1::Event::WARNING, fmt::format("no checkpoint could be written: {}", error.text()));
            error.kind = ErrorKind::Refused;
            commands_.answerCheckpoints(outcome.step, tl::unexpected(std::move(error)));
            continue;
        }
        spdlog::info("checkpoint {} of step {}: {:.1f} MB in {:.2f} s", outcome.written->path, outcome.step,
                     static_cast<double>(outcome.written->bytes) / megabyte, outcome.seconds);
        commands_.answerCheckpoints(outcome.step, std::filesystem::path(outcome.written->path).filename().string());
    }
}

// Ends the step under way, writes the last checkpoint and the end of the log, and waits for the disk.
void SimulationProducer::finishState() {
    const auto end = Clock::now() + longestLastStep;
    sim::Simulation& simulation = host_.simulation();
    while (simulation.midStep() && Clock::now() < end)
        if (auto done = advanceStep(Clock::now()); !done) return;
    keeper_->wait();
    reportCheckpoints();
    if (keeper_->hasFolder() && simulation.midStep())
        spdlog::warn("the step under way takes too long: the last checkpoint is the one before");
    else if (keeper_->hasFolder() && savedVersion_ != version_)
        saveState(Clock::now());
    keeper_->endLog(simulation);
    keeper_->wait();
    reportCheckpoints();
}

Result<void> SimulationProducer::reserveEncoder() {
    return streams_.open(recorder_.rendition(), moment(Clock::now())).map_error([](Error error) {
        error.message = "nothing is recorded: " + error.message;
        return error;
    });
}

Result<void> SimulationProducer::startRecording() {
    if (auto room = reserveEncoder(); !room) return room;
    return recorder_.start();
}

// Begins the log of a new recording. Its state cannot be saved before the step under way has ended.
void SimulationProducer::beginLogInRecording() {
    sim::Simulation& simulation = host_.simulation();
    if (simulation.midStep() || !recorder_.wantsLog()) return;
    if (auto begun = keeper_->beginLogInRecording(simulation, stateHead(), recorder_.logSink()); !begun)
        notify(v1::Event::WARNING, fmt::format("the recording carries no command log: {}", begun.error().text()));
}

Result<void> SimulationProducer::stopRecording() {
    keeper_->endLogInRecording(host_.simulation());
    return recorder_.stop();
}

void SimulationProducer::reportRecording() {
    if (!recorder_.canRecord()) return;
    const auto state = recorder_.changedState(recording::LiveRecorder::Clock::now());
    if (!state) return;
    if (!state->active()) keeper_->dropLogInRecording();
    board_.update([&](ServerStatus& current) {
        current.recording = *state;
        current.recordings = recorder_.files();
    });
    if (!state->failure().empty())
        notify(v1::Event::WARNING, fmt::format("The recording {} has ended: {}.", state->file(), state->failure()));
    v1::ServerMessage message;
    *message.mutable_recording() = *state;
    retain(std::move(message));
}

// Finishes the recording, and logs its end: no viewer is notified any more.
Result<void> SimulationProducer::finishRecording() {
    const heartbeat::Pause writing;  // the disk may take long
    const auto last = recorder_.finish();
    if (!last) return {};
    if (recorder_.endedEmpty()) {  // a stop before the first frame is in order
        spdlog::warn("{}: {}", last->file(), last->failure());
        return {};
    }
    if (!last->failure().empty()) return fail(ErrorKind::Refused, last->file(), last->failure());
    spdlog::info("recorded {:.1f} s in {}, {:.1f} MB", last->duration(), last->file(),
                 static_cast<double>(last->bytes()) / 1e6);
    return {};
}

}  // namespace spherule::host
