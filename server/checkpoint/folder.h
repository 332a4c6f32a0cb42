#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "checkpoint/saved_world.h"
#include "core/result.h"

namespace spherule::checkpoint {

// A folder with numbered checkpoints, of which the newest are kept. One program uses it at a time. Used by one thread.
class Folder {
  public:
    // Makes the folder unless it exists, locks it, and removes the files of checkpoints whose writing was interrupted.
    // A folder that may only be read can be used, but not written. `keep`: number of checkpoints, at least 1. Input if
    // the folder cannot be made or read, or if another program uses it.
    static Result<Folder> open(const std::string& path, unsigned keep);
    Folder(Folder&& other) noexcept;
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    Folder& operator=(Folder&&) = delete;
    ~Folder();

    // Calls use() with the newest checkpoint that can be read, and then with older ones, until use() succeeds. Passes
    // over checkpoints that are damaged or of another version (Input): renames them, so that nothing removes them, and
    // calls skipped() with the reason. Returns its path; nullopt if there is none. Returns any other error, such as no
    // memory or a file that cannot be read: the checkpoint may be good.
    using Use = std::function<Result<void>(SavedWorld world)>;
    Result<std::optional<std::string>> useNewest(const Use& use, const std::function<void(const Error&)>& skipped);

    struct Written {
        std::string path;
        std::uint64_t bytes = 0;
    };
    // Writes a checkpoint to the disk. Then removes the oldest ones that are too many. After an error all others are as
    // before. Refused at once if the disk has too little room for a checkpoint of about the size of the last one. A
    // full disk would end other files, such as the command log.
    Result<Written> write(SavedWorld world);

    [[nodiscard]] const std::string& path() const { return path_; }
    // Returns the number of checkpoints in it.
    [[nodiscard]] std::size_t count() const { return numbers().size(); }

  private:
    Folder(std::string path, unsigned keep, int lock) : path_(std::move(path)), keep_(keep), lock_(lock) {}
    [[nodiscard]] std::vector<std::uint64_t> numbers() const;  // of the checkpoints there are, ascending
    [[nodiscard]] std::string pathOf(std::uint64_t number) const;
    [[nodiscard]] Result<void> checkRoom(std::uint64_t stateBytes) const;
    void removeOldest();

    std::string path_;
    unsigned keep_;
    int lock_;                 // file descriptor of the lock file
    std::uint64_t last_ = 0;   // number of the last checkpoint
    std::uint64_t bytes_ = 0;  // size of the last checkpoint
};

// Returns true for a folder, and for a file that begins as a checkpoint does.
bool isCheckpoint(const std::string& path);
// Returns the newest checkpoint in the folder, or the path itself if it is a file: for programs that only read it.
Result<std::string> newestIn(const std::string& path);

}  // namespace spherule::checkpoint
