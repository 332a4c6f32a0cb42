#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/from_proto.h"
#include "scene/load.h"

namespace spherule::host {

// Watches the file of a scene, and the files that it names, in a thread of its own. It looks at their times, sizes and
// inodes, so that it also sees editors that replace a file by another one.
class SceneWatch {
  public:
    // Returns the paths of the files that a scene's file names.
    using FilesNamed = std::function<Result<std::vector<std::string>>(const std::string& path)>;

    // `period`: between two looks. `named`: called by the thread, and before it begins.
    explicit SceneWatch(std::string path, std::chrono::milliseconds period = std::chrono::milliseconds(500),
                        FilesNamed named = scene::filesNamedIn);

    // Paths of files.
    struct Change {
        std::vector<std::string> saved;
        std::vector<std::string> gone;  // removed, or renamed
    };
    // Returns the changes since the last call, once they have stayed the same for a period; nullopt if there are none.
    // Any thread.
    std::optional<Change> takeChange();
    // Returns the function that loads the file. An error lists the structural mistakes with their places.
    [[nodiscard]] MakeScene load(const std::string& deviceKind, const scene::Overrides& overrides) const;

    // Returns the file whose save is a reason to load the scene; nullopt: it must not be loaded.
    [[nodiscard]] std::optional<std::string> savedToLoad(const Change& change) const;
    // For users: a file is gone; the scene is not loaded after this file was saved.
    [[nodiscard]] std::string goneText(const std::string& file) const;
    [[nodiscard]] std::string failureText(const std::string& saved, const Error& error) const;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string name() const;  // of the file

  private:
    // The state of a file. A file that does not exist has no inode.
    struct Seen {
        std::uint64_t inode = 0;
        std::int64_t size = 0;
        std::int64_t seconds = 0;
        std::int64_t nanoseconds = 0;
        bool operator==(const Seen&) const = default;
    };
    void findFiles();
    void lookForChanges(std::vector<Seen>& last);
    void report(const Change& change);
    [[nodiscard]] static Seen lookAt(const std::string& file);
    [[nodiscard]] std::vector<Seen> look() const;
    void watch(const std::stop_token& stop, std::chrono::milliseconds period);

    std::string path_;
    FilesNamed named_;
    std::vector<std::string> files_;  // the scene's first
    std::vector<Seen> before_;        // when a change was last reported, or at the beginning
    std::mutex mutex_;                // of change_
    std::optional<Change> change_;    // not taken yet
    std::jthread thread_;             // last member: joined before the members that it uses are destroyed
};

}  // namespace spherule::host
