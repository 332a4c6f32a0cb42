#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

#include "core/result.h"

namespace spherule::app {

// Watches over the thread that computes, from a thread of its own: where that shows no sign of life (core/heartbeat.h)
// for `limit`, a kernel or the driver hangs, and nothing that waits for it would ever end.
class Watchdog {
  public:
    using Seconds = std::chrono::duration<double>;
    using Hung = std::function<void(const Error&)>;

    // A limit of 0 is never reached.
    explicit Watchdog(Seconds limit) : limit_(limit) {}

    // `hung` is called once, on the watchdog's thread, with a DeviceLost that says what hangs.
    void start(Hung hung);
    void stop() { thread_ = {}; }  // waits for its thread

    // How long nothing has shown a sign of life. Time in which this program as a whole stood still does not count. Any
    // thread.
    [[nodiscard]] Seconds silence() const { return Seconds(silence_.load()); }
    [[nodiscard]] Seconds limit() const { return limit_; }

  private:
    void watch(const std::stop_token& stop, const Hung& hung);

    Seconds limit_;
    std::atomic<double> silence_ = 0;
    std::jthread thread_;
};

// Ends the program at once, with what has been printed and logged, but without taking anything down: a driver that
// hangs would hang that too.
[[noreturn]] void endNow(int exitCode);

}  // namespace spherule::app
