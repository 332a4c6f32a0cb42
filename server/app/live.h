#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "spherule/v1/frame.pb.h"

namespace spherule::app {

// What the simulation thread last said of itself, for health pages and metrics. Any thread.
struct LiveReport {
    std::string state = "starting";  // starting, running, paused, draining, failed
    std::string device;
    std::string renderer;
    std::string reason;
    std::string scene;
    std::uint32_t spheres = 0;
    std::uint64_t steps = 0;
    double simSeconds = 0;
    std::uint32_t rebuilds = 0;
    std::uint64_t framesProduced = 0;
    v1::Status status;
    std::vector<double> passSeconds;  // since the start, by sim::Pass
    std::chrono::steady_clock::time_point heartbeat = std::chrono::steady_clock::now();
};

class Live {
  public:
    template <class Change>
    void update(Change change) {
        const std::lock_guard lock(mutex_);
        change(report_);
        report_.heartbeat = std::chrono::steady_clock::now();
    }
    [[nodiscard]] LiveReport read() const {
        const std::lock_guard lock(mutex_);
        return report_;
    }

  private:
    mutable std::mutex mutex_;
    LiveReport report_;
};

}  // namespace spherule::app
