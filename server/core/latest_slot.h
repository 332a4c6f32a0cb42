#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace spherule {

// A mailbox for one value between threads. A newer value replaces one that has not been taken. Any thread.
template <class T>
class LatestSlot {
  public:
    // Returns true when it replaced a value.
    bool set(T value) {
        const std::lock_guard lock(mutex_);
        const bool replaced = value_.has_value();
        value_ = std::move(value);
        ready_.notify_one();
        return replaced;
    }

    // Waits for a value; nullopt if closed.
    std::optional<T> take() {
        std::unique_lock lock(mutex_);
        ready_.wait(lock, [this] { return value_.has_value() || closed_; });
        return std::exchange(value_, std::nullopt);
    }

    void close() {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        ready_.notify_all();
    }

  private:
    std::mutex mutex_;
    std::condition_variable ready_;
    std::optional<T> value_;
    bool closed_ = false;
};

}  // namespace spherule
