#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"
#include "recording/record.h"

namespace spherule::recording {

// Returns true if the file begins like a recording.
bool isRecording(const std::string& path);

// The command log that a recording carries: the payloads of its records of this kind, one after the other. The file may
// be cut off or hostile. Used by one thread.
class CarriedLog {
  public:
    // Input if the file cannot be read, or if it carries no log. Reads the heads of all records. In a file that is cut
    // off or damaged, the log ends there.
    static Result<CarriedLog> open(const std::string& path);

    // Reads `count` bytes of the log from `offset` on and returns their number; fewer at its end. Input if the record
    // that has them is damaged. Keeps one record in memory.
    Result<std::size_t> read(std::uint64_t offset, char* bytes, std::size_t count);
    [[nodiscard]] std::uint64_t size() const { return size_; }  // bytes of the log
    // Why the log ends before the recording does; nullopt: it does not.
    [[nodiscard]] const std::optional<Error>& flaw() const { return flaw_; }

  private:
    struct Piece {
        std::uint64_t begin = 0;   // in the log, bytes
        std::uint64_t offset = 0;  // of its record in the file, bytes
    };

    explicit CarriedLog(RecordFile file) : file_(std::move(file)) {}

    RecordFile file_;
    std::vector<Piece> pieces_;
    std::uint64_t size_ = 0;
    std::optional<Error> flaw_;
    std::size_t held_ = 0;  // number of the piece in `payload_`, plus 1
    std::string payload_;
};

}  // namespace spherule::recording
