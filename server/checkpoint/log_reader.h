#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "checkpoint/record_chain.h"
#include "checkpoint/saved_world.h"
#include "core/result.h"
#include "spherule/v1/checkpoint.pb.h"

namespace spherule::checkpoint {

// Reads a command log. Used by one thread.
class LogReader {
  public:
    // Input if the file is no command log.
    static Result<LogReader> open(const std::string& path);

    // Reads the state with which the log begins, or that follows an entry `world`. Call it there, and nowhere else.
    Result<SavedWorld> world() { return readWorld(records_); }
    // Passes over such a state. Returns a digest: equal states that the same version has written have the same one.
    Result<std::uint64_t> digestWorld();
    // Returns the next entry; nullopt at the end of the file. Input if it is cut off or damaged.
    Result<std::optional<v1::LogEntry>> next();

    [[nodiscard]] const std::string& path() const { return records_.path(); }
    [[nodiscard]] const std::string& program() const { return records_.program(); }  // version that wrote the log

  private:
    explicit LogReader(RecordReader records) : records_(std::move(records)) {}

    RecordReader records_;
};

}  // namespace spherule::checkpoint
