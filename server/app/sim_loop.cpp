#include "app/sim_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "app/facts.h"
#include "core/log.h"
#include "core/pulse.h"

namespace spherule::app {

namespace {

using namespace std::chrono_literals;
constexpr auto longestWait = 50ms;  // while paused; a viewer who comes then waits this long for a state
constexpr int commandsPerStep = 32;
constexpr auto oldestAnswer = 100ms;  // to a query, while the world runs by itself

// Whether the world, or how it goes on, may be another after it.
bool changesWorld(const v1::Command& command) {
    return command.has_set() || command.has_load() || command.has_reset() || command.has_spawn() || command.has_push();
}

}  // namespace

SimLoop::SimLoop(std::unique_ptr<World> world, const Stage& stage, quality::Table table, TapeOptions recordings)
    : owned_(std::move(world)),
      world_(*owned_),
      requests_(stage.requests),
      live_(stage.live),
      outlets_(stage.outlets),
      chains_(
          world_.device(), [this](const frame::Link& link) { publish(link); },
          [this](frame::SharedMessage order) {
              tape_.order(order);
              outlets_.order(std::move(order));
          }),
      tape_(std::move(recordings), welcomeOf(world_.device().info())),
      observer_(std::move(table)) {}

Result<void> SimLoop::run(const std::stop_token& stop) {
    announce();
    if (auto done = tape_.startFromOptions(); !done) return done;
    const Result<void> done = simulate(stop);
    const Result<void> finished = finishTape();
    return done ? finished : done;
}

Result<void> SimLoop::simulate(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        pulse::beat("serving viewers");
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
        answerQueries();
        produce(Pacer::Clock::now());
        if (auto done = report(); !done) return done;
        tellOfTape();
    }
    return {};
}

Pacer::Clock::duration SimLoop::patience(Pacer::Clock::time_point now) const {
    Pacer::Clock::duration wait = longestWait;
    if (world_.running()) wait = std::min(wait, world_.pacer().untilDue(now));
    if (const auto due = chains_.due()) wait = std::min(wait, std::max(*due - now, Pacer::Clock::duration{}));
    return wait;
}

void SimLoop::serve(const Request& request) {
    Result<v1::Applied> applied;
    try {
        applied = apply(request.command);
    } catch (const std::bad_alloc&) {
        applied = fail(ErrorKind::Refused, "", "there is not enough memory for this");
    }
    if (applied && changesWorld(request.command)) {
        tuner_.forget();
        observer_.disturbed();
        nextReport_ = {};  // what energy there is at the start is soon gone
    }
    if (applied) announce();
    outlets_.reply(request.session, resultOf(request.command, applied));
}

Result<v1::Applied> SimLoop::apply(const v1::Command& command) {
    Result<void> done;
    if (command.has_start_recording())
        done = tape_.start();
    else if (command.has_stop_recording())
        done = tape_.stop();
    else if (command.has_seek())
        done = fail(ErrorKind::Refused, "", "a simulation has no other time than now: record it, and play that");
    else
        return world_.apply(command);
    if (!done) return tl::unexpected(done.error());
    v1::Applied applied;
    applied.set_step(world_.simulation().steps());
    return applied;
}

// All that wait get the same answer. It shows each command that was applied, and each step that was asked for.
void SimLoop::answerQueries() {
    const auto queries = requests_.takeQueries();
    if (queries.empty()) return;
    const auto now = Pacer::Clock::now();
    if (!answered_ || now - *answered_ > oldestAnswer) {
        try {
            answer_ = world_.apply(queries.front().command);
        } catch (const std::bad_alloc&) {
            answer_ = fail(ErrorKind::Refused, "", "there is not enough memory for this");
        }
        answered_ = now;
    }
    for (const Request& query : queries) outlets_.reply(query.session, resultOf(query.command, answer_));
}

// After anything that a command may have changed.
void SimLoop::announce() {
    answered_.reset();
    if (epoch_ != world_.epoch()) {
        epoch_ = world_.epoch();
        seen_.reset();
        keep(world_.facts());
    }
    v1::ServerMessage settings = world_.settings();
    if (std::string bytes = settings.SerializeAsString(); bytes != settings_) {
        settings_ = std::move(bytes);
        keep(std::move(settings));
    }
    if (observer_.refresh(world_.simulation(), epoch_)) sendDial();
    ++version_;
}

Result<void> SimLoop::step() {
    const auto start = Pacer::Clock::now();
    if (auto done = world_.step(); !done) return done;
    const auto end = Pacer::Clock::now();
    const double wallMs = std::chrono::duration<double, std::milli>(end - start).count();
    world_.pacer().stepped(end);
    observer_.stepped(wallMs);
    ++version_;
    if (world_.paused()) answered_.reset();
    for (const std::string& notice : world_.simulation().takeNotices()) say(v1::Event::WARNING, notice);
    stopAtNonFinite();
    return tune(wallMs);
}

Result<void> SimLoop::tune(double wallMs) {
    auto told = tuner_.stepped(world_.simulation(), wallMs);
    if (!told) return tl::unexpected(told.error());
    if (!*told) return {};
    say(v1::Event::TUNED, **told);
    announce();
    return {};
}

void SimLoop::stopAtNonFinite() {
    if (!world_.simulation().counters().nonFinite) return;
    world_.pause();
    say(v1::Event::NON_FINITE,
        fmt::format("{}. Paused, in the state of the last good step. Use more substeps before you resume.",
                    world_.simulation().divergence()));
    world_.simulation().restore();
    observer_.disturbed();
    announce();
}

void SimLoop::produce(Pacer::Clock::time_point now) {
    auto demands = outlets_.demands();
    watched_ = !demands.empty();
    tape_.demand(demands, now);
    sim::Simulation& simulation = world_.simulation();
    chains_.serve({.source = simulation.tierSource(),
                   .spheres = simulation.count(),
                   .smallestRadius = simulation.radii().smallest,
                   .epoch = epoch_,
                   .version = version_,
                   .positions = [&simulation] { return simulation.snapshot(); },
                   .head = [this, now] { return head(now); }},
                  demands, now);
}

v1::Frame SimLoop::head(Pacer::Clock::time_point now) {
    v1::Frame head;
    head.set_step(world_.simulation().steps());
    head.set_sim_time(world_.simulation().time());
    *head.mutable_status() = status(now);
    return head;
}

void SimLoop::publish(const frame::Link& link) {
    states_.shown(version_, Pacer::Clock::now());
    tape_.frame(link);
    outlets_.frame(link);
}

}  // namespace spherule::app
