#include "host/command_executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include "host/to_proto.h"
#include "net/command_rules.h"
#include "sim/memory_needs.h"

namespace spherule::host {

namespace {

using namespace std::chrono_literals;
constexpr int commandsPerTurn = 32;
constexpr auto commandsTime = 20ms;   // for the waiting commands of a turn
constexpr auto oldestAnswer = 100ms;  // largest age of the answer to a query, while the world runs
constexpr auto longestHold = 500ms;   // longest wait of a command for a change under way
constexpr std::size_t mostHeldBytes = std::size_t{32} << 20U;  // of the commands that wait for it
constexpr std::size_t mostStepCommands = 64;
constexpr std::size_t mostHashQueries = 64;
constexpr std::size_t mostCheckpointCommands = 64;
constexpr std::size_t mostInspections = 64;
constexpr std::ptrdiff_t inspectionsPerSession = 4;
constexpr int restPerInspection = 19;  // times the time of an inspection: all take 5 % of the time at most

constexpr const char* noMemory = "there is not enough memory for this";

}  // namespace

CommandExecutor::CommandExecutor(SimulationHost& host, Requests& requests, net::Publisher& publisher, Effects& effects)
    : host_(host), requests_(requests), publisher_(publisher), effects_(effects) {}

void CommandExecutor::serveWaiting() {
    const auto end = Clock::now() + commandsTime;
    const auto inTime = [end] { return Clock::now() < end; };
    while (!held_.empty() && !host_.changing() && inTime()) execute(takeHeld());
    for (int k = 0; k < commandsPerTurn && inTime(); ++k) {
        auto request = requests_.tryPop();
        if (!request) break;
        serve(std::move(*request));
    }
    const auto now = Clock::now();
    while (host_.changing() && !held_.empty() && now - held_.front().since > longestHold)
        refuse(takeHeld(), changeInWords() + ": wait until that is done, or cancel it", Cause::Busy);
}

void CommandExecutor::serveNext(Clock::duration timeout) {
    if (auto request = requests_.popFor(timeout)) serve(std::move(*request));
}

void CommandExecutor::refuseAll(const std::string& reason, Cause cause) {
    if (change_) refuseChange(reason, cause);
    while (!held_.empty()) refuse(takeHeld(), reason, cause);
    refuseSteps(reason, cause);
    refuseHashQueries(reason, cause);
    refuseCheckpoints(reason, cause);
    for (const Request& inspection : std::exchange(inspections_, {})) refuse(inspection, reason, cause);
}

// Removes and returns the first command that waits for a change.
Request CommandExecutor::takeHeld() {
    Request request = std::move(held_.front().request);
    held_.pop_front();
    heldBytes_ -= request.bytes;
    return request;
}

void CommandExecutor::serve(Request request) {
    // Commands that wait for the end of a change keep their order.
    const bool waits = net::rulesOf(request.command).waits_for_change();
    if (!waits || (!host_.changing() && held_.empty())) return execute(std::move(request));
    if (heldBytes_ + request.bytes > mostHeldBytes)
        return refuse(request, "too many commands wait already for the change under way", Cause::TooManyCommands);
    heldBytes_ += request.bytes;
    held_.push_back({std::move(request), Clock::now()});
}

void CommandExecutor::execute(Request request) {
    const v1::Command& command = request.command;
    const checkpoint::Keeper::Place at = checkpoint::placeOf(host_.simulation());
    const auto applied = apply(request);
    if (!applied && command.has_checkpoint()) {
        checkpointsAsked_.push_back(std::move(request));
    } else if (!applied) {
        if (change_)
            refuseChange(fmt::format("session {} has asked for {}", request.session, wordsFor(command)), Cause::Ended);
        change_ = Pending{std::move(request), Clock::now()};
    } else if (command.has_step() && *applied) {
        effects_.publishChanges();
        const std::uint32_t count = command.step().count();
        steps_.push_back({.command = {std::move(request), Clock::now()}, .left = count});
    } else {
        // Steps that are held came before this command, so it ends them too. After a long change finish() leaves them:
        // they came later.
        if (*applied && net::rulesOf(command).ends_steps()) refuseHeldSteps();
        finish(request, *applied, at);
    }
}

void CommandExecutor::reload(const std::string& name, MakeScene make) {
    Request request;
    request.answered = false;
    request.command.mutable_load()->set_name(name);
    host_.load(std::move(make));
    change_ = Pending{std::move(request), Clock::now()};
}

// `at`: the place of the simulation before the command.
void CommandExecutor::finish(const Request& request, const Result<sim::Applied>& applied,
                             const checkpoint::Keeper::Place& at) {
    const v1::CommandRules& rules = net::rulesOf(request.command);
    if (applied && (rules.changes_world() || request.command.has_pull() || request.command.has_release()))
        effects_.carriedOut(at, request);
    if (applied && rules.changes_world()) effects_.worldChanged();
    if (applied && rules.ends_steps()) refuseSteps("came before all its steps were done", Cause::Ended);
    if (applied) effects_.publishChanges();
    if (!request.answered && request.command.has_load()) effects_.reloaded(applied);
    if (request.answered) publisher_.reply(request.session, resultOf(request.command, applied));
    if (request.answered && applied && rules.announced())
        publisher_.announce(request.session, eventOf(request.command, *applied, spheresOf(request.command, *applied)));
}

// The number of spheres that the last command added or removed.
std::uint64_t CommandExecutor::spheresOf(const v1::Command& command, const sim::Applied& applied) const {
    if (applied.removed) return *applied.removed;
    return command.has_spawn() ? host_.simulation().scene().groups.back().count : 0;
}

// Returns nullopt when a change has begun; its result comes later.
std::optional<Result<sim::Applied>> CommandExecutor::apply(const Request& request) {
    if (request.command.has_step() && steps_.size() >= mostStepCommands)
        return fail(ErrorKind::Refused, "", fmt::format("{} commands to step are not done yet", steps_.size()),
                    Cause::TooManyCommands);
    try {
        return dispatch(request, host_, *this);
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::Refused, "", noMemory, Cause::NoMemory);
    } catch (const std::exception& error) {
        return fail(ErrorKind::Refused, "", error.what());
    }
}

std::optional<Result<sim::Applied>> CommandExecutor::saveCheckpoint() {
    if (auto can = effects_.checkCheckpoints(); !can) return tl::unexpected(can.error());
    if (checkpointsAsked_.size() >= mostCheckpointCommands)
        return fail(ErrorKind::Refused, "", "too many commands wait already for a checkpoint", Cause::TooManyCommands);
    return std::nullopt;
}

void CommandExecutor::checkpointBegun() {
    checkpointsBegun_ = std::exchange(checkpointsAsked_, {});
}

void CommandExecutor::answerCheckpoints(std::uint64_t step, const Result<std::string>& file) {
    for (const Request& request : std::exchange(checkpointsBegun_, {})) {
        Result<sim::Applied> applied = sim::Applied{.step = step};
        if (file)
            applied->file = *file;
        else
            applied = tl::unexpected(file.error());
        publisher_.reply(request.session, resultOf(request.command, applied));
    }
}

void CommandExecutor::refuseCheckpoints(const std::string& reason, Cause cause) {
    for (auto* const waiting : {&checkpointsBegun_, &checkpointsAsked_})
        for (const Request& request : std::exchange(*waiting, {})) refuse(request, reason, cause);
}

Result<void> CommandExecutor::cancel() {
    if (change_) {
        host_.cancelChange();
        refuseChange("cancelled", Cause::Cancelled);
    } else if (!steps_.empty()) {
        host_.pause();
        refuseSteps("cancelled", Cause::Cancelled);
    } else {
        return fail(ErrorKind::Refused, "", "nothing is under way that could be cancelled", Cause::NothingToCancel);
    }
    return {};
}

void CommandExecutor::refuse(const Request& request, const std::string& reason, Cause cause) {
    const auto refused = fail(ErrorKind::Refused, "", reason, cause);
    if (request.answered)
        publisher_.reply(request.session, resultOf(request.command, refused));
    else if (request.command.has_load())
        effects_.reloaded(refused);
    else {
        // Nothing else would end the pull of a session that has ended.
        effects_.carriedOut(checkpoint::placeOf(host_.simulation()), request);
        host_.simulation().release(request.session);
    }
}

// Refuses the change under way and the commands that wait for its end.
void CommandExecutor::refuseChange(const std::string& reason, Cause cause) {
    refuse(change_->request, reason, cause);
    change_.reset();
    while (!held_.empty()) refuse(takeHeld(), reason, cause);
}

// Refuses the step commands that are held: a later command has ended them.
void CommandExecutor::refuseHeldSteps() {
    std::deque<Pending> others;
    for (; !held_.empty(); held_.pop_front()) {
        Pending& pending = held_.front();
        if (!pending.request.command.has_step()) {
            others.push_back(std::move(pending));
            continue;
        }
        heldBytes_ -= pending.request.bytes;
        refuse(pending.request, "none of its steps were done: a later command came before", Cause::Ended);
    }
    held_ = std::move(others);
}

void CommandExecutor::refuseSteps(std::string_view reason, Cause cause) {
    for (const Steps& steps : steps_) {
        const std::uint32_t asked = steps.command.request.command.step().count();
        refuse(steps.command.request, fmt::format("{} of {} steps were done: {}", asked - steps.left, asked, reason),
               cause);
    }
    steps_.clear();
}

void CommandExecutor::advanceChange(Clock::duration slice) {
    const checkpoint::Keeper::Place at = checkpoint::placeOf(host_.simulation());
    std::optional<Result<sim::Applied>> applied;
    try {
        applied = host_.advanceChange(slice);
    } catch (const std::bad_alloc&) {
        host_.cancelChange();
        applied = fail(ErrorKind::Refused, "", noMemory, Cause::NoMemory);
    } catch (const std::exception& error) {
        host_.cancelChange();
        applied = fail(ErrorKind::Refused, "", error.what());
    }
    if (!applied) return;
    const Request request = std::move(change_->request);
    change_.reset();
    finish(request, *applied, at);
}

void CommandExecutor::answerQueries() {
    auto queries = requests_.takeQueries();
    const auto inspections =
        std::ranges::stable_partition(queries, [](const Request& query) { return query.command.has_query(); });
    for (Request& inspection : inspections) {
        const auto own = std::ranges::count(inspections_, inspection.session, &Request::session);
        if (inspections_.size() < mostInspections && own < inspectionsPerSession)
            inspections_.push_back(std::move(inspection));
        else
            refuse(inspection, "as many inspections wait as may: send the next when one has been answered",
                   Cause::TooManyCommands);
    }
    queries.erase(inspections.begin(), inspections.end());
    answerInspections();
    const auto withHash =
        std::ranges::stable_partition(queries, [](const Request& query) { return !query.command.query().hash(); });
    for (Request& query : withHash) {
        if (hashQueries_.size() < mostHashQueries)
            hashQueries_.push_back(std::move(query));
        else
            refuse(query, "as many queries for the hash wait as may: send the next when one has been answered",
                   Cause::TooManyCommands);
    }
    queries.erase(withHash.begin(), withHash.end());
    answerHashQueries();
    if (queries.empty()) return;
    const auto now = Clock::now();
    if (!answered_ || now - *answered_ > oldestAnswer) {
        answer_ = *apply(queries.front());
        answered_ = now;
    }
    for (const Request& query : queries) publisher_.reply(query.session, resultOf(query.command, answer_));
}

// Looks at one sphere after the other, and answers all that ask for it.
void CommandExecutor::answerInspections() {
    while (!inspections_.empty() && Clock::now() >= nextInspection_) {
        const auto begin = Clock::now();
        const std::uint64_t sphere = inspections_.front().command.inspect().sphere();
        const Result<sim::Applied> seen = *apply(inspections_.front());
        std::erase_if(inspections_, [&](const Request& one) {
            if (one.command.inspect().sphere() != sphere) return false;
            publisher_.reply(one.session, resultOf(one.command, seen));
            return true;
        });
        const auto end = Clock::now();
        nextInspection_ = end + restPerInspection * (end - begin);
    }
}

std::optional<CommandExecutor::Clock::time_point> CommandExecutor::due() const {
    if (inspections_.empty()) return std::nullopt;
    return nextInspection_;
}

void CommandExecutor::answerHashQueries() {
    if (hashing_ && hashing_->hash.wait_for(0s) == std::future_status::ready) {
        hashing_->answer.statistics->stateHash = hashing_->hash.get();
        for (const Request& query : hashing_->queries)
            publisher_.reply(query.session, resultOf(query.command, hashing_->answer));
        hashing_.reset();
    }
    if (hashing_ || hashQueries_.empty()) return;
    auto begun = beginHash();
    if (!begun) return refuseHashQueries(begun.error().text(), begun.error().cause);
    begun->queries = std::exchange(hashQueries_, {});
    hashing_ = std::move(*begun);
}

// Copies the state of the device, and starts a thread that hashes the copy.
Result<CommandExecutor::HashQueries> CommandExecutor::beginHash() {
    sim::Simulation& simulation = host_.simulation();
    auto claim = memory::Claim::make("", "a copy of the state", sim::copiesToHash(simulation.plan()));
    if (!claim) return tl::unexpected(claim.error());
    HashQueries begun{.queries = {}, .answer = host_.query(), .claim = std::move(*claim), .hash = {}};
    sim::SlotState slots = simulation.pipeline().download();
    if (auto alive = host_.device().status(); !alive) return tl::unexpected(alive.error());
    begun.hash = std::async(std::launch::async, [slots = std::move(slots), population = simulation.population()] {
        return sim::hashOf(sim::inIdOrder(slots, population));
    });
    return begun;
}

void CommandExecutor::refuseHashQueries(const std::string& reason, Cause cause) {
    if (hashing_) hashQueries_.insert(hashQueries_.begin(), hashing_->queries.begin(), hashing_->queries.end());
    hashing_.reset();
    for (const Request& query : std::exchange(hashQueries_, {})) refuse(query, reason, cause);
}

void CommandExecutor::countStep() {
    if (steps_.empty() || --steps_.front().left > 0) return;
    const Request& request = steps_.front().command.request;
    publisher_.reply(request.session, resultOf(request.command, host_.applied()));
    steps_.pop_front();
}

std::optional<CommandExecutor::Activity> CommandExecutor::activity() const {
    if (change_) {
        Progress::Seen seen = host_.changeProgress();
        return Activity{change_->request, change_->since, std::move(seen.doing), seen.share};
    }
    if (steps_.empty()) return std::nullopt;
    const Steps& steps = steps_.front();
    const std::uint32_t count = steps.command.request.command.step().count();
    return Activity{steps.command.request, steps.command.since, "stepping",
                    static_cast<double>(count - steps.left) / count};
}

std::string CommandExecutor::changeInWords() const {
    if (!change_) return "";
    const Progress::Seen seen = host_.changeProgress();
    return fmt::format("{} is under way ({}, {:.0f} %)", wordsFor(change_->request.command), seen.doing,
                       100 * seen.share);
}

}  // namespace spherule::host
