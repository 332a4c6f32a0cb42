#pragma once

#include <atomic>
#include <cstdint>

namespace spherule {

// Progress and cancellation of long work, shared by the working thread and the threads that wait for it. Any thread.
class Progress {
  public:
    struct Seen {
        const char* doing = "starting";  // a string literal
        double share = 0;                // of `doing`, 0 to 1
        std::uint64_t marks = 0;         // number of calls of at(); unchanged when the work is stuck
    };

    // `doing` must be a string literal, such as "placing spheres".
    void at(const char* doing, double share) {
        doing_.store(doing, std::memory_order_relaxed);
        share_.store(share, std::memory_order_relaxed);
        marks_.fetch_add(1, std::memory_order_relaxed);
    }
    [[nodiscard]] Seen seen() const {
        return {doing_.load(std::memory_order_relaxed), share_.load(std::memory_order_relaxed),
                marks_.load(std::memory_order_relaxed)};
    }

    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    [[nodiscard]] bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

  private:
    std::atomic<const char*> doing_ = Seen().doing;
    std::atomic<double> share_ = 0;
    std::atomic<std::uint64_t> marks_ = 0;
    std::atomic<bool> cancelled_ = false;
};

}  // namespace spherule
