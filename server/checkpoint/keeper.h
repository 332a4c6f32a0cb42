#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "checkpoint/folder.h"
#include "checkpoint/log_writer.h"
#include "checkpoint/options.h"
#include "compute/device.h"
#include "core/task_thread.h"
#include "recording/output_file.h"
#include "sim/simulation.h"
#include "spherule/v1/checkpoint.pb.h"

namespace spherule::checkpoint {

// Writes checkpoints and the command logs of a running simulation: one in a file, one in a recording. Copies of the
// state are made by the caller's thread, which owns the device; threads of its own compress and write them. Used by one
// thread.
class Keeper {
  public:
    using Clock = std::chrono::steady_clock;

    // Opens the folder of checkpoints, if the options name one: see Folder::open(). Warns if it holds checkpoints that
    // will be replaced.
    static Result<std::unique_ptr<Keeper>> open(const Options& options);
    // Finishes what is under way.
    ~Keeper();
    Keeper(const Keeper&) = delete;
    Keeper& operator=(const Keeper&) = delete;

    struct Resumed {
        std::unique_ptr<sim::Simulation> simulation;
        v1::StateHead head;
        std::string path;
    };
    // Makes a simulation from the newest checkpoint from which one can be made. Logs why newer ones were passed over.
    // nullopt if there is none, or if the options do not ask for it. An error if the newest one may be good, but cannot
    // be used now: see Folder::useNewest().
    Result<std::optional<Resumed>> resume(compute::Device& device);

    // Begins the command log with the present state, or goes on with the log to which `resumed` (may be null) belongs.
    // Entries after the checkpoint are removed from it. If the options ask to resume and there is another log, a new
    // one is begun beside it, so that a server that restarts by itself does not end here. Input if the log cannot be
    // written.
    Result<void> beginLog(sim::Simulation& simulation, const v1::StateHead& head, const Resumed* resumed);
    // Begins a command log with the present state in a recording. A log in an earlier recording ends. Refused between
    // two substeps of a step, and if there is no memory for a copy of the state.
    Result<void> beginLogInRecording(sim::Simulation& simulation, const v1::StateHead& head,
                                     std::unique_ptr<recording::ByteSink> sink);
    // Ends it with its last entries, or without: as a log that was cut off.
    void endLogInRecording(sim::Simulation& simulation);
    void dropLogInRecording() { logs_[inRecording].reset(); }

    // Returns true when a checkpoint should be written.
    [[nodiscard]] bool due(Clock::time_point now) const;
    // Copies the state between two steps, and begins to write a checkpoint. Its outcome comes by takeOutcomes().
    // `head`: without the fields that describe the state. Refused without a folder, while one is being written, between
    // two substeps of a step, and if there is no memory for the copy.
    Result<void> save(sim::Simulation& simulation, v1::StateHead head, Clock::time_point now);
    // Call when the state is what it was at the last checkpoint: the next one becomes due later.
    void postpone(Clock::time_point now) { next_ = now + every(); }

    struct Outcome {
        std::uint64_t step = 0;
        double seconds = 0;  // from the copy of the state to the end of the writing
        Result<Folder::Written> written;
    };
    // Returns the outcomes since the last call.
    std::vector<Outcome> takeOutcomes();
    [[nodiscard]] bool hasFolder() const { return folder_.has_value(); }
    [[nodiscard]] bool saving() const { return saving_; }

    // Add entries to the logs that there are. `at`: the place after which the change was made.
    struct Place {
        std::uint64_t step = 0;
        std::uint32_t substep = 0;
    };
    void logCommand(const Place& at, std::uint64_t session, const v1::Command& command);
    void logSubsteps(const Place& at, std::uint32_t substeps);
    void logRollback(const Place& at);
    // Another scene has been loaded.
    void logWorld(const Place& at, sim::Simulation& simulation, const v1::StateHead& head);
    // Call after each step: every so many, a hash is logged.
    void logStep(sim::Simulation& simulation);
    // The last entries of the log in the file.
    void endLog(sim::Simulation& simulation);
    // Hands the entries to the operating system, at most once a second. Call it often.
    void flushLogs(Clock::time_point now);
    // Why logs have ended early, since the last call.
    std::vector<Error> takeLogFailures();

    // Waits until all that was begun is on the disk.
    void wait();

  private:
    explicit Keeper(Options options) : options_(std::move(options)) {}
    [[nodiscard]] Clock::duration every() const { return std::chrono::duration_cast<Clock::duration>(options_.every); }
    [[nodiscard]] bool anyLogGoesOn() const;
    void add(const v1::LogEntry& entry);
    bool goOnWithLog(const v1::StateHead& resumed);
    static void end(LogWriter* log, sim::Simulation& simulation);

    Options options_;
    std::optional<Folder> folder_;  // used by disk_ while it writes a checkpoint
    Clock::time_point next_ = Clock::now();
    bool saving_ = false;
    std::mutex mutex_;  // guards outcomes_
    std::vector<Outcome> outcomes_;
    // Last: their tasks use the others. A task of the log's thread may give one to the disk's thread.
    std::unique_ptr<TaskThread> disk_ = std::make_unique<TaskThread>();
    static constexpr std::size_t inFile = 0;
    static constexpr std::size_t inRecording = 1;
    std::array<std::unique_ptr<LogWriter>, 2> logs_;  // null: there is none
};

// Returns true if a simulation gives the same bits on this device as on the device of the state.
bool givesSameBits(const v1::StateHead& head, const compute::DeviceInfo& device);

// Returns the place of a simulation in its steps.
Keeper::Place placeOf(const sim::Simulation& simulation);

}  // namespace spherule::checkpoint
