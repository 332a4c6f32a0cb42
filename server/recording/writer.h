#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.h"
#include "recording/index.h"
#include "recording/output_file.h"

namespace spherule::recording {

// Writes a recording. After a crash the file is readable up to about 1 s before. A recording without frames is removed
// at the end. Used by one thread. After an error nothing more may be written.
class Writer {
  public:
    // `id`: of the file, see fileIdOf() and randomFileId(). Input if the file exists and `replace` is false.
    static Result<Writer> create(const std::string& path, bool replace, std::uint32_t id);

    // `time` (s simulated) must not decrease. `message`: a ServerMessage in binary form. Scene and order must come
    // before their frames.
    Result<void> add(Kind kind, double time, std::string_view message);

    // Adds the next bytes of a command log, with the time of the record before.
    Result<void> addLog(std::string_view bytes) { return add(Kind::Log, time_, bytes); }

    // Refused if the file has been deleted.
    Result<void> stillThere() { return file_.stillThere(); }
    // Writes index and trailer, and syncs the file to the disk.
    Result<void> finish();

    [[nodiscard]] std::uint64_t bytes() const { return file_.size(); }
    // Size of the finished file (bytes) after one more record with a payload of this size (bytes).
    [[nodiscard]] std::uint64_t bytesWith(std::size_t payload) const;
    [[nodiscard]] std::uint64_t frames() const { return index_.frames; }

  private:
    Writer(OutputFile file, std::uint32_t id) : file_(std::move(file)), head_{.id = id} {}

    OutputFile file_;
    FileHead head_;
    Index index_;
    double time_ = 0;
    std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
};

}  // namespace spherule::recording
