#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "compute/device.h"
#include "spherule/v1/control.pb.h"

namespace spherule::app {

// What the simulation thread last said of itself, for health pages and metrics. Any thread.
struct LiveReport {
    std::string state = "starting";  // starting, running, paused; draining or failed for good
    std::string slow;                // why it may take a while to see what was asked for; empty: it does not
    compute::DeviceInfo device;
    std::vector<std::string> scenes;  // that can be loaded by name
    std::string scene;
    std::uint32_t spheres = 0;
    std::uint64_t steps = 0;
    double simSeconds = 0;
    std::uint32_t rebuilds = 0;
    std::uint64_t framesProduced = 0;
    v1::Status status;
    std::optional<v1::Diagnostics> diagnostics;  // once somebody has watched or asked for metrics
    v1::Recording recording;                     // the present one, or the last
    std::uint64_t recordingFramesLost = 0;
    std::vector<double> passSeconds;  // since the start, by sim::Pass

    [[nodiscard]] bool ends() const { return state == "draining" || state == "failed"; }
    void becomes(const char* next) {
        if (!ends()) state = next;
    }
};

class Live {
  public:
    template <class Change>
    void update(Change change) {
        const std::lock_guard lock(mutex_);
        change(report_);
    }
    [[nodiscard]] LiveReport read() const {
        const std::lock_guard lock(mutex_);
        return report_;
    }

    // Somebody reads the figures, and will want newer ones before long.
    void asked() {
        const std::lock_guard lock(mutex_);
        asked_ = std::chrono::steady_clock::now();
    }
    [[nodiscard]] bool askedWithin(std::chrono::seconds time) const {
        const std::lock_guard lock(mutex_);
        return asked_ && std::chrono::steady_clock::now() - *asked_ < time;
    }

  private:
    mutable std::mutex mutex_;
    std::optional<std::chrono::steady_clock::time_point> asked_;
    LiveReport report_;
};

}  // namespace spherule::app
