#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

#include "core/result.h"

namespace spherule::host {

// Watches the simulation thread from a thread of its own. If there is no heartbeat (core/heartbeat.h) for `limit`, a
// kernel or the driver hangs. Nothing that waits for it would ever end.
class Watchdog {
  public:
    using Seconds = std::chrono::duration<double>;
    using Hung = std::function<void(const Error&)>;

    // A limit of 0 switches the watchdog off.
    explicit Watchdog(Seconds limit) : limit_(limit) {}

    // Calls `hung` once, on the watchdog's thread, with a DeviceLost that names the work that hangs.
    void start(Hung hung);
    void stop() { thread_ = {}; }  // waits for its thread

    // Time since the last heartbeat. Time in which the whole program stood still does not count. Any thread.
    [[nodiscard]] Seconds silence() const { return Seconds(silence_.load()); }
    [[nodiscard]] Seconds limit() const { return limit_; }

  private:
    void watch(const std::stop_token& stop, const Hung& hung);

    Seconds limit_;
    std::atomic<double> silence_ = 0;
    std::jthread thread_;
};

// Ends the program, after it has waited up to 1 s for the log. Destroys nothing, because destructors would hang in a
// driver that hangs.
[[noreturn]] void endNow(int exitCode);

}  // namespace spherule::host
