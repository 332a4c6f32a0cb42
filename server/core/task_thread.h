#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <new>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/result.h"

namespace spherule {

// Calls work(), and turns an exception into an error: Refused, such as for no memory. For tasks.
inline Result<void> guarded(const std::function<Result<void>()>& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::Refused, "", "there is not enough memory for it", Cause::NoMemory);
    } catch (const std::exception& error) {
        return fail(ErrorKind::Refused, "", error.what());
    }
}

// A thread that does tasks in the order in which they are posted. Tasks must not throw. The functions may be called by
// any thread but its own.
class TaskThread {
  public:
    TaskThread() = default;
    TaskThread(const TaskThread&) = delete;
    TaskThread& operator=(const TaskThread&) = delete;
    // Does all tasks first.
    ~TaskThread() { wait(); }

    void post(std::function<void()> task) {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
        changed_.notify_all();
    }
    // Waits until all tasks are done.
    void wait() {
        std::unique_lock lock(mutex_);
        done_.wait(lock, [this] { return tasks_.empty(); });
    }

  private:
    void run(const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        while (changed_.wait(lock, stop, [this] { return !tasks_.empty(); })) {
            // The task stays in the list until it is done. Others are only added behind it.
            std::function<void()>& task = tasks_.front();
            lock.unlock();
            task();
            lock.lock();
            tasks_.pop_front();
            if (tasks_.empty()) done_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::condition_variable done_;
    std::deque<std::function<void()>> tasks_;
    std::jthread thread_{[this](const std::stop_token& stop) { run(stop); }};  // last: it uses the others
};

}  // namespace spherule
