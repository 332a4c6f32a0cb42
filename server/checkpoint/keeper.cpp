#include "checkpoint/keeper.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/heartbeat.h"
#include "core/log.h"
#include "sim/state.h"

namespace spherule::checkpoint {

namespace {

v1::LogEntry entryAt(const Keeper::Place& at) {
    v1::LogEntry entry;
    entry.set_step(at.step);
    entry.set_substep(at.substep);
    return entry;
}

void describe(v1::StateHead& head, const sim::Simulation& simulation) {
    head.set_scene(simulation.scene().name);
    head.set_step(simulation.steps());
    head.set_time(simulation.time());
    head.set_spheres(simulation.count());
}

v1::LogEntry hashOf(sim::Simulation& simulation) {
    v1::LogEntry entry = entryAt(placeOf(simulation));
    entry.set_hash(sim::hashOf(simulation.snapshot()));
    return entry;
}

Result<SavedWorld> presentWorld(sim::Simulation& simulation, const v1::StateHead& head) {
    auto state = simulation.save();
    if (!state) return tl::unexpected(state.error());
    SavedWorld world{.head = head, .state = std::move(*state)};
    describe(world.head, simulation);
    return world;
}

// Begins a log with the present state, `world`, and its hash.
Result<std::unique_ptr<LogWriter>> beginning(sim::Simulation& simulation, SavedWorld world,
                                             std::unique_ptr<recording::ByteSink> sink, std::string name) {
    auto log = LogWriter::begin(std::move(sink), std::move(name));
    if (!log) return log;
    (*log)->addWorld(std::move(world));
    (*log)->add(hashOf(simulation));
    return log;
}

// Returns the number of changes in the log after the position; nullopt if it is not the log of the position.
std::optional<std::size_t> changesAfter(const std::string& path, const v1::LogPosition& position) {
    const heartbeat::Pause reading;
    auto reader = RecordReader::open(path, FileKind::CommandLog);
    if (!reader) return std::nullopt;
    while (reader->position().bytes < position.bytes()) {
        const auto record = reader->next();
        if (!record || !*record) return std::nullopt;
    }
    if (reader->position().bytes != position.bytes() || reader->position().chain != position.chain())
        return std::nullopt;
    std::size_t changes = 0;
    for (auto record = reader->next(); record && *record; record = reader->next()) {
        v1::LogEntry entry;
        if ((*record)->kind != Kind::Entry || !entry.ParseFromString((*record)->payload)) continue;
        changes += entry.has_hash() || entry.has_ended() ? 0 : 1;
    }
    return changes;
}

// Returns NAME.EXTENSION for 1, and NAME-2.EXTENSION, NAME-3.EXTENSION ... for the numbers above.
std::string numbered(const std::string& path, int number) {
    if (number == 1) return path;
    const std::filesystem::path whole(path);
    const std::string name = fmt::format("{}-{}{}", whole.stem().string(), number, whole.extension().string());
    return (whole.parent_path() / name).string();
}

bool exists(const std::string& path) {
    std::error_code error;
    return std::filesystem::exists(path, error);
}

}  // namespace

bool givesSameBits(const v1::StateHead& head, const compute::DeviceInfo& device) {
    const bool onGpu = head.device() == "gpu";
    if (onGpu != (device.kind == "gpu")) return false;
    return !onGpu || head.renderer() == device.renderer;
}

Keeper::Place placeOf(const sim::Simulation& simulation) {
    return {simulation.steps(), simulation.substepsDone()};
}

Result<std::unique_ptr<Keeper>> Keeper::open(const Options& options) {
    if (options.resume && options.folder.empty())
        return fail(ErrorKind::Input, "--resume", "needs the folder of the checkpoints; give --checkpoints FOLDER");
    std::unique_ptr<Keeper> keeper(new Keeper(options));
    if (!options.folder.empty()) {
        auto folder = Folder::open(options.folder, options.keep);
        if (!folder) return tl::unexpected(folder.error());
        keeper->folder_.emplace(std::move(*folder));
        const std::size_t earlier = keeper->folder_->count();
        if (earlier > 0 && !options.resume)
            spdlog::warn(
                "{} holds {} checkpoints of an earlier run, which new ones replace; --resume goes on from them",
                options.folder, earlier);
    }
    // If the program is killed soon, the next one shall not go on from the earlier run.
    const bool atOnce = keeper->folder_ && !options.resume && keeper->folder_->count() > 0;
    if (!atOnce) keeper->postpone(Clock::now());
    return keeper;
}

Keeper::~Keeper() {
    wait();
}

void Keeper::wait() {
    const heartbeat::Pause writing;  // the disk may take long
    for (const auto& log : logs_)
        if (log) log->wait();
    disk_->wait();
}

Result<std::optional<Keeper::Resumed>> Keeper::resume(compute::Device& device) {
    if (!options_.resume || !folder_) return std::nullopt;
    Resumed resumed;
    const auto use = [&](SavedWorld world) -> Result<void> {
        auto made = sim::Simulation::restore(device, world.state);
        if (!made) return tl::unexpected(made.error());
        resumed.simulation = std::move(*made);
        resumed.head = std::move(world.head);
        return {};
    };
    const auto skipped = [](const Error& error) { spdlog::error("a checkpoint is passed over: {}", error.text()); };
    auto path = folder_->useNewest(use, skipped);
    if (!path) return tl::unexpected(path.error());
    if (!*path) return std::nullopt;
    resumed.path = std::move(**path);
    if (!givesSameBits(resumed.head, device.info()))
        spdlog::warn("{} was made on {}, and goes on on {}: results may differ in their last bits", resumed.path,
                     resumed.head.renderer(), device.info().renderer);
    return resumed;
}

// Goes on with the log, or with one beside it that an earlier start has begun. Returns false if none is the log of the
// checkpoint.
bool Keeper::goOnWithLog(const v1::StateHead& resumed) {
    if (!resumed.has_log()) return false;
    for (int number = 1; exists(numbered(options_.log, number)); ++number) {
        const std::string path = numbered(options_.log, number);
        const auto changes = changesAfter(path, resumed.log());
        if (!changes) continue;
        auto file = recording::OutputFile::goOn(path, resumed.log().bytes());
        if (!file) continue;
        if (*changes > 0)
            spdlog::warn("{} commands and decisions of {} are removed: they came after the checkpoint", *changes, path);
        options_.log = path;
        logs_[inFile] =
            std::make_unique<LogWriter>(std::make_unique<recording::OutputFile>(std::move(*file)), path,
                                        Position{.bytes = resumed.log().bytes(), .chain = resumed.log().chain()});
        return true;
    }
    return false;
}

Result<void> Keeper::beginLog(sim::Simulation& simulation, const v1::StateHead& head, const Resumed* resumed) {
    if (options_.log.empty()) return {};
    if (resumed != nullptr && goOnWithLog(resumed->head)) return {};
    if (options_.resume && !options_.replace && exists(options_.log)) {
        int number = 2;
        while (exists(numbered(options_.log, number))) ++number;
        const std::string before = std::exchange(options_.log, numbered(options_.log, number));
        spdlog::warn("{} is not the log of this state; a new command log begins in {}", before, options_.log);
    }
    auto world = presentWorld(simulation, head);  // without it, no file is left behind
    if (!world) return tl::unexpected(world.error());
    auto file = recording::OutputFile::create(options_.log, options_.replace);
    if (!file) return tl::unexpected(file.error());
    file->persist();
    auto log = beginning(simulation, std::move(*world), std::make_unique<recording::OutputFile>(std::move(*file)),
                         options_.log);
    if (!log) return tl::unexpected(log.error());
    logs_[inFile] = std::move(*log);
    return {};
}

Result<void> Keeper::beginLogInRecording(sim::Simulation& simulation, const v1::StateHead& head,
                                         std::unique_ptr<recording::ByteSink> sink) {
    auto world = presentWorld(simulation, head);
    if (!world) return tl::unexpected(world.error());
    auto log = beginning(simulation, std::move(*world), std::move(sink), "the recording");
    if (!log) return tl::unexpected(log.error());
    logs_[inRecording] = std::move(*log);
    return {};
}

bool Keeper::due(Clock::time_point now) const {
    return folder_ && !saving_ && now >= next_;
}

Result<void> Keeper::save(sim::Simulation& simulation, v1::StateHead head, Clock::time_point now) {
    if (!folder_)
        return fail(ErrorKind::Refused, "", "no folder for checkpoints was given: start with --checkpoints FOLDER",
                    Cause::NoCheckpoints);
    if (saving_) return fail(ErrorKind::Refused, "", "a checkpoint is being written: wait for it", Cause::Busy);
    postpone(now);
    auto state = simulation.save();
    if (!state) return tl::unexpected(state.error());
    describe(head, simulation);
    const std::uint64_t step = simulation.steps();
    // Tasks are copied, worlds are not.
    auto world = std::make_shared<SavedWorld>(SavedWorld{.head = std::move(head), .state = std::move(*state)});
    saving_ = true;
    const auto report = [this, step, now](Result<Folder::Written> written) {
        const double seconds = std::chrono::duration<double>(Clock::now() - now).count();
        const std::lock_guard lock(mutex_);
        outcomes_.push_back({.step = step, .seconds = seconds, .written = std::move(written)});
    };
    const auto save = [this, world, report](std::optional<Position> log) {
        if (log) {
            world->head.mutable_log()->set_bytes(log->bytes);
            world->head.mutable_log()->set_chain(log->chain);
        }
        disk_->post([this, world, report] {
            Folder::Written written;
            const auto done = guarded([&]() -> Result<void> {
                auto made = folder_->write(std::move(*world));
                if (!made) return tl::unexpected(made.error());
                written = std::move(*made);
                return {};
            });
            report(done ? Result<Folder::Written>(std::move(written)) : tl::unexpected(done.error()));
        });
    };
    // The log has the entries up to this state when its thread comes to this task.
    if (logs_[inFile])
        logs_[inFile]->sync(save);
    else
        save(std::nullopt);
    return {};
}

std::vector<Keeper::Outcome> Keeper::takeOutcomes() {
    std::vector<Outcome> outcomes;
    if (!saving_) return outcomes;
    const std::lock_guard lock(mutex_);
    outcomes = std::exchange(outcomes_, {});
    if (!outcomes.empty()) saving_ = false;
    return outcomes;
}

bool Keeper::anyLogGoesOn() const {
    return std::ranges::any_of(logs_, [](const auto& log) { return log && log->goesOn(); });
}

void Keeper::add(const v1::LogEntry& entry) {
    for (const auto& log : logs_)
        if (log) log->add(entry);
}

void Keeper::logCommand(const Place& at, std::uint64_t session, const v1::Command& command) {
    v1::LogEntry entry = entryAt(at);
    entry.mutable_carried()->set_session(session);
    *entry.mutable_carried()->mutable_command() = command;
    add(entry);
}

void Keeper::logSubsteps(const Place& at, std::uint32_t substeps) {
    v1::LogEntry entry = entryAt(at);
    entry.set_substeps(substeps);
    add(entry);
}

void Keeper::logRollback(const Place& at) {
    v1::LogEntry entry = entryAt(at);
    entry.mutable_rolled_back();
    add(entry);
}

void Keeper::logWorld(const Place& at, sim::Simulation& simulation, const v1::StateHead& head) {
    if (!anyLogGoesOn()) return;
    v1::LogEntry entry = entryAt(at);
    entry.mutable_world();
    for (const auto& log : logs_) {
        if (!log || !log->goesOn()) continue;
        auto world = presentWorld(simulation, head);
        if (!world) {
            log->endWith(world.error());
            continue;
        }
        log->add(entry);
        log->addWorld(std::move(*world));
        log->add(hashOf(simulation));
    }
}

void Keeper::logStep(sim::Simulation& simulation) {
    if (options_.hashEvery > 0 && simulation.steps() % options_.hashEvery == 0 && anyLogGoesOn())
        add(hashOf(simulation));
}

void Keeper::endLog(sim::Simulation& simulation) {
    end(logs_[inFile].get(), simulation);
}

void Keeper::endLogInRecording(sim::Simulation& simulation) {
    end(logs_[inRecording].get(), simulation);
}

void Keeper::end(LogWriter* log, sim::Simulation& simulation) {
    if (log == nullptr || !log->goesOn()) return;
    log->add(hashOf(simulation));
    v1::LogEntry entry = entryAt(placeOf(simulation));
    entry.mutable_ended();
    log->add(entry);
    log->close();
}

void Keeper::flushLogs(Clock::time_point now) {
    for (const auto& log : logs_)
        if (log) log->flush(now);
}

std::vector<Error> Keeper::takeLogFailures() {
    std::vector<Error> failures;
    for (const auto& log : logs_)
        if (log)
            if (auto failure = log->takeFailure()) failures.push_back(std::move(*failure));
    return failures;
}

}  // namespace spherule::checkpoint
