#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "host/from_proto.h"

namespace spherule::host {

// Watches the file of a scene, and the files that it names, in a thread of its own. It looks at their times, sizes and
// inodes, so that it also sees editors that replace a file by another one.
class SceneWatch {
  public:
    // `period`: between two looks.
    explicit SceneWatch(std::string path, std::chrono::milliseconds period = std::chrono::milliseconds(500));

    // Returns true once after a file has changed, and has then stayed the same for a period. Any thread.
    bool takeChange() { return changed_.exchange(false); }
    // Returns the function that loads the file. An error lists the structural mistakes with their places.
    [[nodiscard]] MakeScene load(const std::string& deviceKind, const scene::Overrides& overrides) const;

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
    [[nodiscard]] static Seen lookAt(const std::string& file);
    [[nodiscard]] std::vector<Seen> look() const;
    void watch(const std::stop_token& stop, std::chrono::milliseconds period);

    std::string path_;
    std::vector<std::string> files_;  // the scene's first
    std::vector<Seen> before_;        // when the scene was last reported, or at the beginning
    std::atomic<bool> changed_ = false;
    std::jthread thread_;  // last member: joined before the members that it uses are destroyed
};

}  // namespace spherule::host
