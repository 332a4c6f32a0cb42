#include "host/replay.h"

#include <utility>

#include <fmt/format.h>

#include "host/from_proto.h"
#include "host/to_proto.h"
#include "sim/state.h"

namespace spherule::host {

std::string nameOf(const v1::LogEntry& entry) {
    switch (entry.kind_case()) {
        case v1::LogEntry::kCarried:
            return fmt::format("{} of session {}", wordsFor(entry.carried().command()), entry.carried().session());
        case v1::LogEntry::kSubsteps:
            return fmt::format("{} substeps by the goal for quality", entry.substeps());
        case v1::LogEntry::kRolledBack:
            return "a return to the last good state";
        case v1::LogEntry::kHash:
            return fmt::format("the hash {:016x}", entry.hash());
        case v1::LogEntry::kWorld:
            return "another scene";
        case v1::LogEntry::kEnded:
            return "the end";
        case v1::LogEntry::KIND_NOT_SET:
            break;
    }
    return "nothing";
}

Result<std::unique_ptr<Replay>> Replay::open(const std::string& path, compute::Device& device) {
    auto log = checkpoint::LogReader::open(path);
    if (!log) return tl::unexpected(log.error());
    std::unique_ptr<Replay> replay(new Replay(std::move(*log), device));
    if (auto done = replay->begin(); !done) return tl::unexpected(done.error());
    if (auto done = replay->readNext(); !done) return tl::unexpected(done.error());
    return replay;
}

tl::unexpected<Error> Replay::bad(const std::string& what) const {
    return fail(ErrorKind::Input, log_.path(), what);
}

// Begins with the state that the log has next.
Result<void> Replay::begin() {
    auto world = log_.world();
    if (!world) return tl::unexpected(world.error());
    auto made = sim::Simulation::restore(device_, world->state);
    if (!made) return made.error().kind == ErrorKind::Input ? bad(made.error().text()) : tl::unexpected(made.error());
    simulation_ = std::move(*made);
    head_ = std::move(world->head);
    return {};
}

Result<void> Replay::readNext() {
    auto entry = log_.next();
    if (!entry) return tl::unexpected(entry.error());
    next_ = std::move(*entry);
    return {};
}

Result<bool> Replay::step() {
    for (;;) {
        const auto more = makeChanges();
        if (!more || !*more) return more;
        const auto ended = simulation_->advance();
        if (!ended) return tl::unexpected(ended.error());
        if (!*ended) continue;
        ++counts_.steps;
        return true;
    }
}

// Makes the changes for the present place. Returns false at the end of the log.
Result<bool> Replay::makeChanges() {
    while (next_ && next_->step() == simulation_->steps() && next_->substep() == simulation_->substepsDone()) {
        if (auto done = makeChange(); !done) return tl::unexpected(done.error());
        if (ended_) return false;
        if (auto done = readNext(); !done) return tl::unexpected(done.error());
    }
    if (!next_) return false;
    const bool passed = next_->step() < simulation_->steps() ||
                        (next_->step() == simulation_->steps() && next_->substep() < simulation_->substepsDone());
    if (passed)
        return bad(fmt::format(
            "has {} after substep {} of step {}, which the run does not reach again: it is at "
            "substep {} of step {}",
            nameOf(*next_), next_->substep(), next_->step(), simulation_->substepsDone(), simulation_->steps()));
    return true;
}

Result<void> Replay::makeChange() {
    switch (next_->kind_case()) {
        case v1::LogEntry::kCarried:
            return carryOut(next_->carried());
        case v1::LogEntry::kSubsteps:
            ++counts_.decisions;
            return simulation_->chooseSubsteps(next_->substeps()).map_error([&](Error error) {
                error.where = log_.path();
                return error;
            });
        case v1::LogEntry::kRolledBack:
            simulation_->rollback();
            return {};
        case v1::LogEntry::kHash:
            compare(next_->hash());
            return {};
        case v1::LogEntry::kWorld:
            return begin();
        case v1::LogEntry::kEnded:
            ended_ = true;
            return {};
        case v1::LogEntry::KIND_NOT_SET:
            break;
    }
    return {};
}

Result<void> Replay::carryOut(const v1::Carried& carried) {
    ++counts_.commands;
    const auto command = worldCommandOf(carried.command(), carried.session());
    if (!command) return bad(fmt::format("has {}, which is no command for a simulation", nameOf(*next_)));
    if (!*command) return bad(fmt::format("has {}, which is wrong: {}", nameOf(*next_), command->error().text()));
    const auto applied = simulation_->apply(**command);
    const bool atFault = !applied && applied.error().cause != Cause::NoMemory &&
                         (applied.error().kind == ErrorKind::Input || applied.error().kind == ErrorKind::Refused);
    if (!applied && !atFault) return tl::unexpected(applied.error());
    if (!applied)
        return bad(fmt::format("has {} at step {}, which is refused now: {}", nameOf(*next_), next_->step(),
                               applied.error().text()));
    return {};
}

void Replay::compare(std::uint64_t logged) {
    const std::uint64_t found = sim::hashOf(simulation_->snapshot());
    ++counts_.hashes;
    if (mismatch_) return;
    if (found == logged)
        lastMatch_ = simulation_->steps();
    else
        mismatch_ = Mismatch{.step = simulation_->steps(), .logged = logged, .found = found};
}

}  // namespace spherule::host
