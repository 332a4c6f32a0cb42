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

// With head and checksum, as it stands in the file. The payload is at most mostPayload long.
std::string recordBytes(Kind kind, double time, std::string_view payload);

std::string fileHead();

// The records of a file, which may be hostile or cut off anywhere. Used by one thread.
class RecordFile {
  public:
    // Input for what is no recording, and why.
    static Result<RecordFile> open(const std::string& path);

    // What begins at this offset; Input where that is no whole and sound record. Takes memory for its payload only
    // where the file is as long as the record says.
    [[nodiscard]] Result<Record> read(std::uint64_t offset) const;
    // The same without the payload, which is not looked at.
    [[nodiscard]] Result<Record> readHead(std::uint64_t offset) const;

    // Where the index begins by the file's last bytes; 0: they say nothing of it.
    [[nodiscard]] std::uint64_t indexOffset() const;

    [[nodiscard]] std::uint64_t size() const { return file_.size(); }  // bytes, when it was opened
    [[nodiscard]] const std::string& path() const { return file_.path(); }

  private:
    explicit RecordFile(InputFile file) : file_(std::move(file)) {}
    bool get(std::uint64_t offset, char* bytes, std::size_t count) const;
    [[nodiscard]] tl::unexpected<Error> bad(std::uint64_t offset, const std::string& what) const;

    InputFile file_;
};

}  // namespace spherule::recording
