#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace spherule::compute::cpu {

// Threads for very many very short loops: a run costs little more than 1 us if the threads are awake. Each thread
// begins with its own share of the range, the same in every run, so that its cache may still hold the data. A thread
// that has finished helps the others. run() does not wait for a thread that has not begun. One thread at a time may
// call run().
class Pool {
  public:
    using Body = void (*)(const void* context, std::uint32_t begin, std::uint32_t end);

    explicit Pool(unsigned threads);  // including the thread that calls run(); throws std::system_error
    ~Pool();
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    [[nodiscard]] unsigned threads() const { return static_cast<unsigned>(workers_.size()) + 1; }

    // Calls `body` with ranges of at most `grain` that together are 0 .. count - 1. Returns when all calls have ended
    // and their writes are visible. If there is a single range, the caller's thread does it.
    void run(std::uint32_t count, std::uint32_t grain, Body body, const void* context);

  private:
    struct alignas(64) Share {
        std::atomic<std::uint32_t> next = 0;
        std::uint32_t end = 0;
    };

    void work(unsigned self);
    void serve(unsigned self);
    void close();
    void stop();

    // The current run. Written only while the gate is closed and no worker is inside.
    Body body_ = nullptr;
    const void* context_ = nullptr;
    std::uint32_t grain_ = 1;
    std::unique_ptr<Share[]> shares_;  // by thread

    // Bit 0: open. Bits 1 to 31: number of workers inside. From bit 32 on: number of the run.
    alignas(64) std::atomic<std::uint64_t> gate_ = 0;
    std::atomic<bool> stop_ = false;
    unsigned patience_ = 0;  // checks of the gate before a worker sleeps
    std::vector<std::jthread> workers_;
};

}  // namespace spherule::compute::cpu
