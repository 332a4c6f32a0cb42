#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "checkpoint/log_reader.h"
#include "compute/device.h"
#include "core/result.h"
#include "sim/simulation.h"

namespace spherule::host {

// Carries out a command log again: begins with its state, and makes each change at the place at which it was made. Used
// by the thread that owns the device.
class Replay {
  public:
    // The device must outlive the replay. Input if the log cannot be read, or is of another format. Any other error
    // is of the device, or says that there is no memory.
    static Result<std::unique_ptr<Replay>> open(const std::string& path, compute::Device& device);

    // Makes the changes that are next, and does substeps to the end of the step. Returns false at the end of the log:
    // after its last entry, there are no more steps. Input if the log is damaged, or if its entries do not fit the
    // simulation. Any other error is of the device, or says that there is no memory.
    Result<bool> step();

    // A hash in the log that the state does not have.
    struct Mismatch {
        std::uint64_t step = 0;
        std::uint64_t logged = 0;
        std::uint64_t found = 0;
    };
    [[nodiscard]] const std::optional<Mismatch>& firstMismatch() const { return mismatch_; }
    // The last step before it at which a hash was equal.
    [[nodiscard]] std::optional<std::uint64_t> lastMatch() const { return lastMatch_; }

    struct Counts {
        std::uint64_t steps = 0;  // that were done
        std::uint64_t commands = 0;
        std::uint64_t decisions = 0;  // of the substeps, by the goal for quality
        std::uint64_t hashes = 0;     // that were compared
    };
    [[nodiscard]] const Counts& counts() const { return counts_; }
    [[nodiscard]] bool complete() const { return ended_; }  // the log has an end: it was not cut off
    [[nodiscard]] sim::Simulation& simulation() { return *simulation_; }
    [[nodiscard]] const v1::StateHead& head() const { return head_; }  // of the state with which the log begins
    [[nodiscard]] const std::string& program() const { return log_.program(); }

  private:
    Replay(checkpoint::LogReader log, compute::Device& device) : log_(std::move(log)), device_(device) {}
    Result<void> begin();
    Result<void> readNext();
    Result<bool> makeChanges();
    Result<void> makeChange();
    Result<void> carryOut(const v1::Carried& carried);
    void compare(std::uint64_t logged);
    [[nodiscard]] tl::unexpected<Error> bad(const std::string& what) const;

    checkpoint::LogReader log_;
    compute::Device& device_;
    v1::StateHead head_;
    std::unique_ptr<sim::Simulation> simulation_;
    std::optional<v1::LogEntry> next_;
    std::optional<Mismatch> mismatch_;
    std::optional<std::uint64_t> lastMatch_;
    Counts counts_;
    bool ended_ = false;
};

// The name of an entry for people, such as "push of session 3" or "12 substeps by the goal for quality".
std::string nameOf(const v1::LogEntry& entry);

}  // namespace spherule::host
