#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"

namespace spherule::store {

// A file that is written from beginning to end, through a buffer. Used by one thread. What goes wrong is Input where it
// cannot be opened and Refused where it cannot be written; then all that was written before stays, and
// nothing more is written.
class OutputFile {
  public:
    // Refuses a file that is there, unless it may be replaced.
    static Result<OutputFile> create(const std::string& path, bool replace);

    OutputFile(OutputFile&& other) noexcept;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();  // what is in the buffer is not written

    Result<void> write(std::string_view bytes);
    Result<void> flush();  // to the operating system
    Result<void> close();  // to the disk

    [[nodiscard]] std::uint64_t size() const { return size_; }  // bytes, with those in the buffer
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    OutputFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
    Result<void> put(std::string_view bytes);
    [[nodiscard]] tl::unexpected<Error> cannot(int error);

    std::string path_;
    int descriptor_;
    std::string buffer_;
    std::uint64_t size_ = 0;
    std::uint64_t written_ = 0;
    std::optional<Error> failed_;
};

}  // namespace spherule::store
