#include "app/sim_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "app/to_proto.h"
#include "core/heartbeat.h"
#include "core/log.h"
#include "net/command_rules.h"

namespace spherule::app {

namespace {

using namespace std::chrono_literals;
constexpr auto longestWait = 50ms;  // longest wait of a new viewer for a state while paused
constexpr int commandsPerTurn = 32;
constexpr auto oldestAnswer = 100ms;  // largest age of the answer to a query, while the world runs
// A step up to this long is done as a whole. Commands are served between the substeps of a longer step.
constexpr auto wholeStep = 100ms;
constexpr auto sliceOfStep = 20ms;
constexpr auto sliceOfChange = 5ms;  // at least; as long as the step of the same turn, if there is one
constexpr auto longestHold = 500ms;  // longest wait of a command for a change under way
constexpr std::size_t mostHeldBytes = std::size_t{32} << 20U;  // of the commands that wait for it
constexpr std::size_t mostStepCommands = 64;

constexpr const char* noMemory = "there is not enough memory for this";

}  // namespace

SimLoop::SimLoop(std::unique_ptr<World> world, const Stage& stage, quality::Table table, TapeOptions recordings)
    : owned_(std::move(world)),
      world_(*owned_),
      requests_(stage.requests),
      live_(stage.live),
      outlets_(stage.outlets),
      chains_(
          world_.device(), [this](const codec::EncodedFrame& encoded) { publish(encoded); },
          [this](codec::SharedMessage order) {
              tape_.order(order);
              outlets_.order(std::move(order));
          },
          [this](const std::string& text) { say(v1::Event::WARNING, text); }),
      tape_(std::move(recordings), welcomeOf(world_.device().info())),
      observer_(std::move(table)) {}

Result<void> SimLoop::run(const std::stop_token& stop) {
    announce();
    if (tape_.beginsByItself())
        if (auto room = roomForTape(); !room) return room;
    if (auto done = tape_.startFromOptions(); !done) return done;
    const Result<void> done = simulate(stop);
    const Result<void> finished = finishTape();
    return done ? finished : done;
}

Result<void> SimLoop::simulate(const std::stop_token& stop) {
    Result<void> done;
    while (done && !stop.stop_requested()) {
        heartbeat::beat("serving viewers");
        serveWaiting();
        const bool worked = goOn(done);
        if (!done) break;
        answerQueries();
        tellOfChange();
        lookAtStill();
        done = report();
        produce(Pacer::Clock::now());
        tellOfTape();
        if (worked) continue;
        if (auto request = requests_.popFor(patience(Pacer::Clock::now()))) serve(std::move(*request));
    }
    constexpr const char* reason = "the server is stopping";
    if (change_) refuseChange(reason);
    while (!held_.empty()) refuse(takeHeld(), reason);
    refuseSteps(reason);
    return done;
}

// Does a part of the step under way and of the change under way. Returns false when there is neither.
bool SimLoop::goOn(Result<void>& done) {
    const auto start = Pacer::Clock::now();
    const bool due = world_.running() && world_.pacer().untilDue(start) == Pacer::Clock::duration{};
    if (due) done = stepFor(start);
    if (!done || !world_.changing()) return due;
    advanceChange(std::max<Pacer::Clock::duration>(sliceOfChange, Pacer::Clock::now() - start));
    return true;
}

Pacer::Clock::duration SimLoop::patience(Pacer::Clock::time_point now) const {
    Pacer::Clock::duration wait = longestWait;
    if (world_.running()) wait = std::min(wait, world_.pacer().untilDue(now));
    if (const auto due = chains_.due()) wait = std::min(wait, std::max(*due - now, Pacer::Clock::duration{}));
    return wait;
}

void SimLoop::serveWaiting() {
    const auto end = Pacer::Clock::now() + sliceOfStep;
    const auto inTime = [end] { return Pacer::Clock::now() < end; };
    while (!held_.empty() && !world_.changing() && inTime()) carryOut(takeHeld());
    for (int k = 0; k < commandsPerTurn && inTime(); ++k) {
        auto request = requests_.tryPop();
        if (!request) break;
        serve(std::move(*request));
    }
    const auto now = Pacer::Clock::now();
    while (world_.changing() && !held_.empty() && now - held_.front().since > longestHold)
        refuse(takeHeld(), changeInWords() + ": wait until that is done, or cancel it");
}

// Removes and returns the first command that waits for a change.
Request SimLoop::takeHeld() {
    Request request = std::move(held_.front().request);
    held_.pop_front();
    heldBytes_ -= request.bytes;
    return request;
}

void SimLoop::serve(Request request) {
    // Commands that wait for the end of a change keep their order.
    const bool waits = net::rulesOf(request.command).waits_for_change();
    if (!waits || (!world_.changing() && held_.empty())) return carryOut(std::move(request));
    if (heldBytes_ + request.bytes > mostHeldBytes)
        return refuse(request, "too many commands wait already for the change under way");
    heldBytes_ += request.bytes;
    held_.push_back({std::move(request), Pacer::Clock::now()});
}

void SimLoop::carryOut(Request request) {
    const v1::Command& command = request.command;
    const auto applied = apply(command);
    if (!applied) {
        if (change_) refuseChange(fmt::format("session {} has asked for {}", request.session, wordsFor(command)));
        change_ = Asked{std::move(request), Pacer::Clock::now()};
    } else if (command.has_step() && *applied) {
        announce();
        const std::uint32_t count = command.step().count();
        steps_.push_back({.asked = {std::move(request), Pacer::Clock::now()}, .left = count});
    } else {
        // Steps that are held came before this command, so it ends them too. After a long change finish() leaves them:
        // they came later.
        if (*applied && net::rulesOf(command).ends_steps()) refuseHeldSteps();
        finish(request, *applied);
    }
}

void SimLoop::finish(const Request& request, const Result<sim::Applied>& applied) {
    const v1::CommandRules& rules = net::rulesOf(request.command);
    if (applied && rules.changes_world()) {
        tellNotices();
        tuner_.forget();
        observer_.disturbed();
        nextReport_ = {};  // measures the energy at the start, before steps change it
        if (!world_.simulation().midStep()) stepMs_ = 0;
    }
    if (applied && rules.ends_steps()) refuseSteps("came before all its steps were done");
    if (applied) announce();
    outlets_.reply(request.session, resultOf(request.command, applied));
}

// Returns nullopt when a change has begun; its result comes later.
std::optional<Result<sim::Applied>> SimLoop::apply(const v1::Command& command) {
    if (command.has_step() && steps_.size() >= mostStepCommands)
        return fail(ErrorKind::Refused, "", fmt::format("{} commands to step are not done yet", steps_.size()));
    try {
        return dispatch(command, world_, *this);
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::Refused, "", noMemory);
    } catch (const std::exception& error) {
        return fail(ErrorKind::Refused, "", error.what());
    }
}

Result<void> SimLoop::cancel() {
    if (change_) {
        world_.cancelChange();
        refuseChange("cancelled");
    } else if (!steps_.empty()) {
        world_.pause();
        refuseSteps("cancelled");
    } else {
        return fail(ErrorKind::Refused, "", "nothing is under way that could be cancelled");
    }
    return {};
}

void SimLoop::refuse(const Request& request, const std::string& reason) {
    outlets_.reply(request.session, resultOf(request.command, fail(ErrorKind::Refused, "", reason)));
}

// Refuses the change under way and the commands that wait for its end.
void SimLoop::refuseChange(const std::string& reason) {
    refuse(change_->request, reason);
    change_.reset();
    while (!held_.empty()) refuse(takeHeld(), reason);
}

// Refuses the step commands that are held: a later command has ended them.
void SimLoop::refuseHeldSteps() {
    std::deque<Asked> others;
    for (; !held_.empty(); held_.pop_front()) {
        Asked& asked = held_.front();
        if (!asked.request.command.has_step()) {
            others.push_back(std::move(asked));
            continue;
        }
        heldBytes_ -= asked.request.bytes;
        refuse(asked.request, "none of its steps were done: a later command came before");
    }
    held_ = std::move(others);
}

void SimLoop::refuseSteps(std::string_view reason) {
    for (const Steps& steps : steps_) {
        const std::uint32_t asked = steps.asked.request.command.step().count();
        refuse(steps.asked.request, fmt::format("{} of {} steps were done: {}", asked - steps.left, asked, reason));
    }
    steps_.clear();
}

// Does a part of the change under way, and answers its command at the end.
void SimLoop::advanceChange(Pacer::Clock::duration slice) {
    std::optional<Result<sim::Applied>> applied;
    try {
        applied = world_.advanceChange(slice);
    } catch (const std::bad_alloc&) {
        world_.cancelChange();
        applied = fail(ErrorKind::Refused, "", noMemory);
    } catch (const std::exception& error) {
        world_.cancelChange();
        applied = fail(ErrorKind::Refused, "", error.what());
    }
    if (!applied) return;
    const Request request = std::move(change_->request);
    change_.reset();
    finish(request, *applied);
}

// Gives all waiting queries the same answer. It includes every applied command and every completed step command.
void SimLoop::answerQueries() {
    const auto queries = requests_.takeQueries();
    if (queries.empty()) return;
    const auto now = Pacer::Clock::now();
    if (!answered_ || now - *answered_ > oldestAnswer) {
        answer_ = *apply(queries.front().command);
        answered_ = now;
    }
    for (const Request& query : queries) outlets_.reply(query.session, resultOf(query.command, answer_));
}

// Sends the scene facts, settings and dial that have changed. Call after any change.
void SimLoop::announce() {
    answered_.reset();
    if (epoch_ != world_.epoch()) {
        epoch_ = world_.epoch();
        seen_.reset();
        retain(world_.facts());
    }
    v1::ServerMessage settings = world_.settings();
    if (std::string bytes = settings.SerializeAsString(); bytes != settings_) {
        settings_ = std::move(bytes);
        retain(std::move(settings));
    }
    if (observer_.refresh(world_.simulation(), epoch_)) sendDial();
    ++version_;
}

// Advances the step under way, or the next one, until it ends or commands must be served.
Result<void> SimLoop::stepFor(Pacer::Clock::time_point now) {
    const auto slice = world_.simulation().midStep() ? sliceOfStep : wholeStep;
    const auto ended = world_.advance(now + slice);
    const auto end = Pacer::Clock::now();
    stepMs_ += std::chrono::duration<double, std::milli>(end - now).count();
    if (!ended) return tl::unexpected(ended.error());
    if (!*ended) return {};
    if (std::exchange(missed_, false)) nextReport_ = {};
    const double wallMs = std::exchange(stepMs_, 0);
    world_.pacer().stepped(end);
    observer_.stepped(wallMs);
    ++version_;
    if (world_.paused()) answered_.reset();
    tellNotices();
    stopAtNonFinite();
    countStep();
    return tune(wallMs);
}

// Counts a step for the oldest step command, and answers the command after its last step.
void SimLoop::countStep() {
    if (steps_.empty() || --steps_.front().left > 0) return;
    const Request& request = steps_.front().asked.request;
    outlets_.reply(request.session, resultOf(request.command, world_.applied()));
    steps_.pop_front();
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
    refuseSteps("a position or velocity became non-finite");
    world_.simulation().rollback();
    observer_.disturbed();
    announce();
}

// Makes a report due when the world has stopped, before the frame of this state is produced. The status of that frame
// then belongs to this state.
void SimLoop::lookAtStill() {
    watched_ = !outlets_.subscriptions().empty();
    if (world_.running() || !watched_ || world_.simulation().midStep()) return;
    if (!seen_ || seen_->statistics().step() != world_.simulation().steps()) nextReport_ = {};
}

void SimLoop::produce(Pacer::Clock::time_point now) {
    auto subscriptions = outlets_.subscriptions();
    tape_.subscribe(subscriptions, now);
    chains_.serve(scenery(now), subscriptions, now);
}

Scenery SimLoop::scenery(Pacer::Clock::time_point now) {
    sim::Simulation& simulation = world_.simulation();
    return {.source = simulation.tierSource(),
            .spheres = simulation.count(),
            .smallestRadius = simulation.radii().smallest,
            .epoch = epoch_,
            .version = version_,
            .positions = [&simulation] { return simulation.snapshot(); },
            .head = [this, now] { return head(now); }};
}

v1::Frame SimLoop::head(Pacer::Clock::time_point now) {
    v1::Frame head;
    head.set_step(world_.simulation().steps());
    head.set_sim_time(world_.simulation().time());
    *head.mutable_status() = status(now);
    return head;
}

void SimLoop::publish(const codec::EncodedFrame& encoded) {
    states_.shown(version_, Pacer::Clock::now());
    tape_.frame(encoded);
    outlets_.frame(encoded);
}

}  // namespace spherule::app
