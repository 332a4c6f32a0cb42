#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"

namespace spherule::recording {

// Where bytes are written one after the other: a file, or a part of one. After an error nothing more is written.
class ByteSink {
  public:
    ByteSink() = default;
    ByteSink(const ByteSink&) = delete;
    ByteSink& operator=(const ByteSink&) = delete;
    virtual ~ByteSink() = default;

    virtual Result<void> write(std::string_view bytes) = 0;
    virtual Result<void> flush() { return {}; }  // to the operating system
    virtual Result<void> sync() { return {}; }   // to the disk
    virtual Result<void> close() { return {}; }  // nothing follows
    // True if nothing more is written because of an error that its owner reports.
    [[nodiscard]] virtual bool ended() const { return false; }
};

// A file that is written sequentially through a buffer. Used by one thread. Errors: Input if it cannot be opened;
// Refused if it cannot be written, and nothing more is written then. A file that is destroyed before persist() or
// close() is removed.
class OutputFile : public ByteSink {
  public:
    // When the file appears under its name: with the first write, or when it is complete. Until then the data is in a
    // temporary file next to it.
    enum class Appears { AtOnce, WhenClosed };

    // Input if the file exists and `replace` is false. The file is replaced by the first write, or when it is closed.
    // Devices and pipes are always written directly.
    static Result<OutputFile> create(const std::string& path, bool replace, Appears appears = Appears::AtOnce);
    static Result<OutputFile> standardOutput();
    // Goes on with a file at the end of its first `bytes` bytes. The bytes beyond them are removed. Input if the file
    // is shorter or no regular file.
    static Result<OutputFile> goOn(const std::string& path, std::uint64_t bytes);

    OutputFile(OutputFile&& other) noexcept;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile() override;  // does not write the buffer

    // Keeps a file that appears at once when it is destroyed before close().
    void persist() { persistent_ = true; }
    // Refused if the file has been deleted.
    Result<void> stillThere();

    Result<void> write(std::string_view bytes) override;
    Result<void> flush() override;  // to the operating system
    Result<void> sync() override;   // to the disk
    Result<void> close() override;  // to the disk, with its name

    [[nodiscard]] std::uint64_t size() const { return size_; }  // bytes, including the buffer
    [[nodiscard]] const std::string& path() const { return path_; }

  private:
    OutputFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
    Result<void> publish();
    Result<void> syncName(const std::string& path);
    Result<void> writeBytes(std::string_view bytes);
    [[nodiscard]] tl::unexpected<Error> cannot(int error);

    std::string path_;
    int descriptor_;
    std::string place_;     // path until it is closed; empty: no regular file
    std::string target_;    // path after it is closed; empty: unchanged
    bool replace_ = false;  // an existing file at the target may be replaced
    bool stale_ = false;    // the file still has its old content
    bool unnamed_ = false;  // its name at place_ may not be on the disk yet
    bool persistent_ = false;
    std::string buffer_;
    std::uint64_t size_ = 0;
    std::uint64_t written_ = 0;
    std::optional<Error> failed_;
};

// Writes the names in a folder to the disk: without this, new ones may be lost with the power of the machine. Returns
// errno; 0 also if the folder or its file system does not allow it.
int syncNamesIn(const std::string& folder);

}  // namespace spherule::recording
