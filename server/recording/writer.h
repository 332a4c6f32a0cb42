#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.h"
#include "recording/index.h"
#include "recording/output_file.h"

namespace spherule::recording {

// Writes a recording: from its first frame on, what is in it can be read at any snapshot up to about a second before,
// whatever happens then. One without frames is removed at the end. Used by one thread. After an error nothing more is
// to be written.
class Writer {
  public:
    // Refuses a file that is there, unless it may be replaced.
    static Result<Writer> create(const std::string& path, bool replace);

    // `time`: s simulated, never less than the last. `message`: a ServerMessage in protobuf's binary form. Frames need
    // their scene and order before them.
    Result<void> add(Kind kind, double time, std::string_view message);

    // Refused when the file has been deleted.
    Result<void> stillThere() { return file_.stillThere(); }
    // Index and trailer, and all of it to the disk.
    Result<void> finish();

    [[nodiscard]] std::uint64_t bytes() const { return file_.size(); }
    // Of the file once it is finished, if another record of so long a payload comes.
    [[nodiscard]] std::uint64_t bytesWith(std::size_t payload) const;
    [[nodiscard]] std::uint64_t frames() const { return index_.frames; }

  private:
    explicit Writer(OutputFile file) : file_(std::move(file)) {}

    OutputFile file_;
    Index index_;
    double time_ = 0;
    std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
};

}  // namespace spherule::recording
