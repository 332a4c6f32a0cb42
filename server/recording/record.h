#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/input_file.h"
#include "core/result.h"
#include "recording/format.h"

// Records of docs/recordings.md.
namespace spherule::recording {

struct Record {
    Kind kind = Kind::Other;
    double time = 0;  // s simulated
    std::string payload;
    std::uint64_t end = 0;  // where the next record begins in the file
};

// The head of a file.
struct FileHead {
    std::uint32_t version = formatVersion;
    // Tells recordings apart: checksums are of it. 0 in version 1.
    std::uint32_t id = 0;

    [[nodiscard]] std::string bytes() const;
};

// Returns an id that follows from `content`.
std::uint32_t fileIdOf(std::string_view content);
// Returns an id that no other recording has, with a probability of 1 - 2^-32 for each. Any thread.
std::uint32_t randomFileId();

// Returns the checksum of a record. `record`: its head and payload. `offset`: of the record in the file (bytes).
std::uint64_t checksumOf(std::string_view record, const FileHead& file, std::uint64_t offset);

// Returns a record with head and checksum, as at `offset` of the file. The payload has at most mostPayload bytes.
std::string recordBytes(Kind kind, double time, std::string_view payload, const FileHead& file, std::uint64_t offset);

// Reads the records of a file, which may be hostile or cut off. Used by one thread.
class RecordFile {
  public:
    // Input if the file is no recording, or of a version that is not known.
    static Result<RecordFile> open(const std::string& path);

    // Reads the record at `offset`. Input if it is cut off, damaged, or in version 2 a record of another place or file.
    // Allocates memory for the payload only if the file is long enough for it.
    [[nodiscard]] Result<Record> read(std::uint64_t offset) const;
    // Same as read(), but without the payload and its checksum.
    [[nodiscard]] Result<Record> readHead(std::uint64_t offset) const;

    // Offset of the index, from the trailer; 0 if there is no trailer.
    [[nodiscard]] std::uint64_t indexOffset() const;

    [[nodiscard]] const FileHead& head() const { return head_; }
    [[nodiscard]] std::uint64_t size() const { return file_.size(); }  // bytes, at the time of open()
    [[nodiscard]] const std::string& path() const { return file_.path(); }

  private:
    explicit RecordFile(InputFile file) : file_(std::move(file)) {}
    bool get(std::uint64_t offset, char* bytes, std::size_t count) const;
    [[nodiscard]] tl::unexpected<Error> bad(std::uint64_t offset, const std::string& what) const;

    InputFile file_;
    FileHead head_;
};

}  // namespace spherule::recording
