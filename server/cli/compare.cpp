#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "checkpoint/log_reader.h"
#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/progress_line.h"
#include "compute/device.h"
#include "core/log.h"
#include "host/replay.h"
#include "host/watchdog.h"
#include "sim/state.h"

namespace spherule::cli {

namespace {

struct CompareOptions {
    std::string one;
    std::string other;
    std::string device = "auto";
    double watchdog = 0;
};

// The first entries in which two logs differ; nullopt: the log has no more changes.
struct Difference {
    std::optional<v1::LogEntry> one;
    std::optional<v1::LogEntry> other;
    bool ofWorlds = false;                         // the states with which they begin, or that follow `one` and `other`
    std::optional<std::uint64_t> lastEqualHash{};  // step

    // Returns true if the states differ although all changes before are equal.
    [[nodiscard]] bool ofHashes() const { return one && other && one->has_hash() && other->has_hash(); }
};

// A log whose next entry can be looked at. The end of a log is no entry.
class Entries {
  public:
    static Result<Entries> open(const std::string& path) {
        auto log = checkpoint::LogReader::open(path);
        if (!log) return tl::unexpected(log.error());
        return Entries(std::move(*log));
    }
    Result<std::uint64_t> digestWorld() { return log_.digestWorld(); }
    Result<void> next() {
        auto entry = log_.next();
        if (!entry) return tl::unexpected(entry.error());
        now = *entry && (*entry)->has_ended() ? std::nullopt : std::move(*entry);
        return {};
    }

    std::optional<v1::LogEntry> now;

  private:
    explicit Entries(checkpoint::LogReader log) : log_(std::move(log)) {}
    checkpoint::LogReader log_;
};

bool samePlace(const v1::LogEntry& one, const v1::LogEntry& other) {
    return one.step() == other.step() && one.substep() == other.substep();
}

// Numbers of sessions and of commands differ from run to run.
bool same(v1::LogEntry one, v1::LogEntry other) {
    for (v1::LogEntry* const entry : {&one, &other})
        if (entry->has_carried()) {
            entry->mutable_carried()->clear_session();
            entry->mutable_carried()->mutable_command()->clear_id();
        }
    return one.SerializeAsString() == other.SerializeAsString();
}

// Returns true if only one log has the hash that is next. Hashes may be logged at different steps.
bool isOnlyIn(const Entries& one, const Entries& other) {
    if (!one.now || !one.now->has_hash()) return false;
    return !other.now || !other.now->has_hash() || !samePlace(*one.now, *other.now);
}

// Returns true if the place of the first is before the place of the second.
bool isBefore(const v1::LogEntry& one, const v1::LogEntry& other) {
    return std::pair(one.step(), one.substep()) < std::pair(other.step(), other.substep());
}

// Returns the first difference; nullopt if there is none.
Result<std::optional<Difference>> firstDifference(const CompareOptions& options) {
    auto one = Entries::open(options.one);
    if (!one) return tl::unexpected(one.error());
    auto other = Entries::open(options.other);
    if (!other) return tl::unexpected(other.error());
    Difference difference;
    for (bool world = true;;) {
        if (std::exchange(world, false)) {
            const auto a = one->digestWorld();
            if (!a) return tl::unexpected(a.error());
            const auto b = other->digestWorld();
            if (!b) return tl::unexpected(b.error());
            difference.ofWorlds = *a != *b;
            if (difference.ofWorlds) return difference;
        }
        if (auto read = one->next(); !read) return tl::unexpected(read.error());
        if (auto read = other->next(); !read) return tl::unexpected(read.error());
        // If two hashes are at different places, the earlier one is in one log alone.
        for (;;) {
            const bool both = one->now && other->now && one->now->has_hash() && other->now->has_hash();
            if (isOnlyIn(*one, *other) && (!both || isBefore(*one->now, *other->now))) {
                if (auto read = one->next(); !read) return tl::unexpected(read.error());
            } else if (isOnlyIn(*other, *one)) {
                if (auto read = other->next(); !read) return tl::unexpected(read.error());
            } else {
                break;
            }
        }
        difference.one = one->now;
        difference.other = other->now;
        if (!one->now && !other->now) return std::nullopt;
        if (!one->now || !other->now || !same(*one->now, *other->now)) return difference;
        world = one->now->has_world();
        if (one->now->has_hash()) difference.lastEqualHash = one->now->step();
        // The steps are counted anew.
        if (world || (one->now->has_carried() && one->now->carried().command().has_reset()))
            difference.lastEqualHash.reset();
    }
}

// Carries out both logs side by side. Returns the first step after which their states differ; nullopt if they do not
// differ while both go on.
Result<std::optional<std::uint64_t>> firstStep(const CompareOptions& options, compute::Device& device) {
    auto one = host::Replay::open(options.one, device);
    if (!one) return tl::unexpected(one.error());
    auto other = host::Replay::open(options.other, device);
    if (!other) return tl::unexpected(other.error());
    ProgressLine progress;
    for (;;) {
        sim::Simulation& a = (*one)->simulation();
        sim::Simulation& b = (*other)->simulation();
        if (a.steps() != b.steps() || sim::hashOf(a.snapshot()) != sim::hashOf(b.snapshot()))
            return std::max(a.steps(), b.steps());
        progress.show([&] { return fmt::format("equal at step {} ", a.steps()); });
        const auto goesOn = (*one)->step();
        if (!goesOn) return tl::unexpected(goesOn.error());
        const auto otherGoesOn = (*other)->step();
        if (!otherGoesOn) return tl::unexpected(otherGoesOn.error());
        if (!*goesOn || !*otherGoesOn) return std::nullopt;
    }
}

std::string describe(const std::string& file, const std::optional<v1::LogEntry>& entry) {
    if (!entry) return fmt::format("{} has no more changes", file);
    return fmt::format("{} has {} at step {}", file, host::nameOf(*entry), entry->step());
}

// Returns the exit code.
Result<int> compare(const CompareOptions& options) {
    Interrupt interrupt;
    const auto found = firstDifference(options);
    if (!found) return tl::unexpected(found.error());
    if (!*found) {
        fmt::print("the runs are equal\n");
        return exitDone;
    }
    const Difference& difference = **found;
    if (difference.ofWorlds)
        fmt::print(
            "{} and {} have different states {}\n", options.one, options.other,
            difference.one ? fmt::format("after the load at step {}", difference.one->step()) : "at the beginning");
    else
        fmt::print("{}; {}\n", describe(options.one, difference.one), describe(options.other, difference.other));
    if (!difference.ofWorlds && difference.ofHashes()) {
        const std::uint64_t step = std::max(difference.one->step(), difference.other->step());
        if (!difference.lastEqualHash)
            fmt::print("the states differ from the beginning of the world on, at step {}\n", step);
        else if (*difference.lastEqualHash + 1 == step)
            fmt::print("the states differ from step {} on\n", step);
        else
            fmt::print("the states differ from a step after {} on, up to {}; record with --hash-every 1 to know it\n",
                       *difference.lastEqualHash, step);
        return exitDiffers;
    }
    host::Watchdog watchdog{host::Watchdog::Seconds(options.watchdog)};
    watchdog.start([](const Error& error) { host::endNow(printError(error)); });
    auto device = compute::openDevice(options.device);
    if (!device) return tl::unexpected(device.error());
    const auto step = firstStep(options, **device);
    if (!step) return tl::unexpected(step.error());
    if (*step)
        fmt::print("the states differ from step {} on\n", **step);
    else
        fmt::print("the states are equal as long as both runs go on\n");
    return exitDiffers;
}

}  // namespace

void addCompare(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "find the first step at which two runs differ, by their logs");
    command->add_option("one", options->one, "a file of --log, or a recording of --record-log")->required();
    command->add_option("other", options->other, "another one")->required();
    command->add_option("--device", options->device, "auto, gpu, gpu:N, gpu:cuda:N, cpu, cpu:THREADS or software")
        ->capture_default_str();
    addWatchdog(*command, options->watchdog);
    command->footer(exitCodesText);
    command->callback([options, &exitCode] {
        const auto done = compare(*options);
        exitCode = done ? *done : printError(done.error());
    });
}

}  // namespace spherule::cli
