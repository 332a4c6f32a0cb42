#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace spherule {

// A queue between threads that refuses when full. Any thread.
template <class T>
class BoundedQueue {
  public:
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

    // False when full: the caller tells whoever sent the value.
    [[nodiscard]] bool push(T value) {
        const std::lock_guard lock(mutex_);
        if (items_.size() >= capacity_) return false;
        items_.push_back(std::move(value));
        ready_.notify_one();
        return true;
    }

    std::optional<T> tryPop() {
        const std::lock_guard lock(mutex_);
        return popLocked();
    }

    // Waits up to `timeout` for a value.
    std::optional<T> popFor(std::chrono::nanoseconds timeout) {
        std::unique_lock lock(mutex_);
        ready_.wait_for(lock, timeout, [this] { return !items_.empty(); });
        return popLocked();
    }

  private:
    std::optional<T> popLocked() {
        if (items_.empty()) return std::nullopt;
        std::optional<T> value(std::move(items_.front()));
        items_.pop_front();
        return value;
    }

    std::mutex mutex_;
    std::condition_variable ready_;
    std::deque<T> items_;
    const std::size_t capacity_;
};

}  // namespace spherule
