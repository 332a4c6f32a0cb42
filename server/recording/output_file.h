#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"

namespace spherule::recording {

// A file that is written from beginning to end, through a buffer. Used by one thread. What goes wrong is Input where it
// cannot be opened and Refused where it cannot be written; then nothing more is written. A file that is destroyed
// before persist() or close() is removed.
class OutputFile {
  public:
    // When there is a file of that name: from the first write on, or only once it is complete. Before, what is written
    // is in a file beside it.
    enum class Appears { AtOnce, WhenClosed };

    // Refuses a file that is there, unless it may be replaced. It is replaced by the first write, or when it is closed.
    // Devices and pipes are always written directly.
    static Result<OutputFile> create(const std::string& path, bool replace, Appears appears = Appears::AtOnce);
    static Result<OutputFile> standardOutput();

    OutputFile(OutputFile&& other) noexcept;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();  // what is in the buffer is not written

    // From here on, a file that appears at once stays as far as it is written.
    void persist() { persistent_ = true; }
    // Refused when the file has been deleted.
    Result<void> stillThere();

    Result<void> write(std::string_view bytes);
    Result<void> flush();  // to the operating system
    Result<void> close();  // to the disk

    [[nodiscard]] std::uint64_t size() const { return size_; }  // bytes, with those in the buffer
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    OutputFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
    Result<void> publish();
    Result<void> put(std::string_view bytes);
    [[nodiscard]] tl::unexpected<Error> cannot(int error);

    std::string path_;
    int descriptor_;
    std::string place_;     // where it is on the disk until it is closed; empty: no regular file
    std::string target_;    // where it goes then; empty: it stays at its place
    bool replace_ = false;  // what is at the target
    bool stale_ = false;    // it still has the content that it had before
    bool persistent_ = false;
    std::string buffer_;
    std::uint64_t size_ = 0;
    std::uint64_t written_ = 0;
    std::optional<Error> failed_;
};

}  // namespace spherule::recording
