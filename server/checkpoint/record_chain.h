#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/result.h"

// The files of checkpoints and command logs: a head and records, see docs/checkpoints.md. The checksum of a record
// covers the checksum of the record before it. So a record that is changed, missing, or from another place or file does
// not pass for a good one.
namespace spherule::checkpoint {

enum class FileKind : std::uint8_t { Checkpoint, CommandLog };

enum class Kind : std::uint32_t {
    State = 1,  // a StateHead: its parts follow
    Part = 2,   // of the state: see saved_world.h
    End = 3,    // of the state
    Entry = 4,  // a LogEntry
};

constexpr std::uint32_t formatVersion = 1;        // of both kinds of files
constexpr std::uint32_t mostPayload = 1U << 26U;  // bytes

struct Record {
    Kind kind{};
    std::string payload;
};

constexpr std::size_t magicBytes = 8;  // at the beginning of a file, by its kind

// Returns the head of a file, in which all checksums begin.
std::string headOf(FileKind kind);

// A place between two records.
struct Position {
    std::uint64_t bytes = 0;  // from the beginning of the file
    std::uint64_t chain = 0;  // checksum of the record before
};
Position positionAfter(std::string_view head);

// Returns the record as it follows `position`, which moves behind it. The payload has at most mostPayload bytes.
std::string recordBytes(Kind kind, std::string_view payload, Position& position);

// Reads the records of a file, which may be damaged or hostile. Used by one thread. Errors: Input, with the path.
class RecordReader {
  public:
    // Refuses a file of another kind, and names the program that wrote a file of another version. For a recording,
    // reads the command log that it carries.
    static Result<RecordReader> open(const std::string& path, FileKind kind);

    // Returns the next record; nullopt at the end of the file. Input if it is cut off or damaged.
    Result<std::optional<Record>> next();
    [[nodiscard]] const Position& position() const { return position_; }
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::uint64_t size() const { return size_; }             // bytes
    [[nodiscard]] const std::string& program() const { return program_; }  // version that wrote the file
    [[nodiscard]] tl::unexpected<Error> bad(const std::string& what) const;

  private:
    // Reads `count` bytes from `offset` on and returns their number; fewer at the end.
    using Read = std::function<Result<std::size_t>(std::uint64_t offset, char* bytes, std::size_t count)>;

    RecordReader(std::string path, std::uint64_t size, Read read)
        : path_(std::move(path)), size_(size), read_(std::move(read)) {}
    static Result<RecordReader> openBytes(const std::string& path, FileKind kind);
    Result<std::string> bytes(std::uint64_t offset, std::size_t count) const;

    std::string path_;
    std::uint64_t size_ = 0;
    Read read_;
    std::optional<Error> flaw_;  // why the file ends there
    std::string program_;
    Position position_;
};

}  // namespace spherule::checkpoint
