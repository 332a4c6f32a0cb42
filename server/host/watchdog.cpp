#include "host/watchdog.h"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <mutex>

#include "core/heartbeat.h"
#include "core/log.h"

namespace spherule::host {

namespace {

constexpr double looks = 20;  // checks within the limit

}  // namespace

void Watchdog::start(Hung hung) {
    if (limit_.count() <= 0) return;
    thread_ = std::jthread([this, hung = std::move(hung)](const std::stop_token& stop) { watch(stop, hung); });
}

void Watchdog::watch(const std::stop_token& stop, const Hung& hung) {
    pthread_setname_np(pthread_self(), "watchdog");
    using Clock = std::chrono::steady_clock;
    const Seconds between = std::min(limit_ / looks, Seconds(1));
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    std::uint64_t beats = 0;
    auto then = Clock::now();
    while (!ended.wait_for(lock, stop, between, [] { return false; }) && !stop.stop_requested()) {
        const auto now = Clock::now();
        const heartbeat::Status sign = heartbeat::status();
        // After a stop of the program or a sleep of the machine, this thread wakes late. That time does not count.
        const double more = std::min(Seconds(now - then), 2 * between).count();
        silence_ = sign.beats == beats && sign.expected ? silence_ + more : 0;
        beats = sign.beats;
        then = now;
        if (silence() < limit_) continue;
        return hung(
            Error{ErrorKind::DeviceLost, "watchdog",
                  fmt::format("nothing has progressed for {:g} s ({}): the device or its driver hangs, or needs "
                              "a longer --watchdog",
                              limit_.count(), sign.doing)});
    }
}

void endNow(int exitCode) {
    (void)logIsWritten();
    _exit(exitCode);
}

}  // namespace spherule::host
