#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "checkpoint/record_chain.h"
#include "checkpoint/saved_world.h"
#include "core/result.h"
#include "core/task_thread.h"
#include "recording/output_file.h"
#include "spherule/v1/checkpoint.pb.h"

namespace spherule::checkpoint {

// Writes a command log to a file or into a recording, on a thread of its own. The first error ends the log. Used by one
// thread.
class LogWriter {
  public:
    using Clock = std::chrono::steady_clock;

    // Begins a log. `sink`: where its bytes go; the thread uses it. `name`: of the file, for messages. An error if the
    // sink takes no bytes.
    static Result<std::unique_ptr<LogWriter>> begin(std::unique_ptr<recording::ByteSink> sink, std::string name);
    // Goes on with a log that ends at `position`.
    LogWriter(std::unique_ptr<recording::ByteSink> sink, std::string name, Position position);
    // Writes what was added, without an entry for the end.
    ~LogWriter();
    LogWriter(const LogWriter&) = delete;
    LogWriter& operator=(const LogWriter&) = delete;

    // Adds an entry. Ends the log if 64 MiB of entries wait for the disk.
    void add(const v1::LogEntry& entry);
    // Adds a state. Its memory is freed when it is written.
    void addWorld(SavedWorld world);
    // Hands the entries to the operating system, at most once a second.
    void flush(Clock::time_point now);
    // Brings the log to the disk, then calls `then` with its end, or with nullopt if the log has ended. The thread
    // calls it.
    void sync(std::function<void(std::optional<Position>)> then);
    // Closes the file after what was added. Nothing more may be added.
    void close();
    // Ends the log early.
    void endWith(const Error& error);

    [[nodiscard]] bool goesOn() const { return goesOn_; }
    // Why the log has ended early; nullopt: it has not, or this was returned before.
    std::optional<Error> takeFailure();
    void wait() { thread_.wait(); }

  private:
    void post(std::function<Result<void>()> write);
    void drop(const Error& error);

    const std::string name_;
    bool goesOn_ = true;
    bool unflushed_ = false;  // entries were added since flush() began to flush
    Clock::time_point flushed_{};
    std::atomic<std::size_t> queued_ = 0;  // bytes of entries that the thread has not written
    std::mutex mutex_;
    std::optional<Error> failure_;  // guarded by mutex_

    // Used by the thread.
    std::unique_ptr<recording::ByteSink> sink_;  // null: the log has ended
    Position position_;
    TaskThread thread_;  // last: its tasks use the others
};

}  // namespace spherule::checkpoint
