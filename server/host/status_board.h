#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "compute/device.h"
#include "scene/catalog.h"
#include "spherule/v1/control.pb.h"

namespace spherule::host {

// The latest status of the simulation thread, for health pages and metrics.
struct ServerStatus {
    std::string state = "starting";  // starting, running or paused; draining and failed are final
    std::string slow;                // why commands or states may be late; empty: they are not
    compute::DeviceInfo device;
    std::vector<std::string> scenes;           // names of scenes that can be loaded
    std::vector<scene::CatalogEntry> catalog;  // the scenes of the program
    std::string scene;
    std::uint64_t born = 0;
    std::uint64_t removed = 0;
    std::uint32_t spheres = 0;
    std::uint64_t steps = 0;
    double simSeconds = 0;
    std::uint32_t rebuilds = 0;
    std::uint64_t framesProduced = 0;
    v1::Status status;
    std::optional<v1::Diagnostics> diagnostics;  // set while a viewer watches, or soon after a request for metrics
    v1::Recording recording;                     // the present recording, or the last one
    std::vector<std::string> recordings;         // files in the folder of recordings that this server has begun
    std::uint64_t recordingFramesLost = 0;
    // The checkpoints; nullopt: there is no folder for them.
    struct Checkpoints {
        std::uint64_t written = 0;
        std::uint64_t failed = 0;
        std::uint64_t bytes = 0;                         // of the last one
        std::chrono::steady_clock::time_point safeAt{};  // when the last one was copied; at first, the start
    };
    std::optional<Checkpoints> checkpoints;
    std::vector<double> passSeconds;  // device time (s) while passes were timed, by sim::Pass

    [[nodiscard]] bool isFinal() const { return state == "draining" || state == "failed"; }
    void setState(const char* next) {
        if (!isFinal()) state = next;
    }
};

// Holds the latest status. Any thread.
class StatusBoard {
  public:
    template <class Change>
    void update(Change change) {
        const std::lock_guard lock(mutex_);
        change(status_);
    }
    [[nodiscard]] ServerStatus read() const {
        const std::lock_guard lock(mutex_);
        return status_;
    }

    // Records that a client reads the figures, and will want newer ones soon.
    void noteRead() {
        const std::lock_guard lock(mutex_);
        read_ = std::chrono::steady_clock::now();
    }
    [[nodiscard]] bool readWithin(std::chrono::seconds time) const {
        const std::lock_guard lock(mutex_);
        return read_ && std::chrono::steady_clock::now() - *read_ < time;
    }

  private:
    mutable std::mutex mutex_;
    std::optional<std::chrono::steady_clock::time_point> read_;
    ServerStatus status_;
};

}  // namespace spherule::host
