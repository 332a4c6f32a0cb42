#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace spherule::compute::cpu {

// Threads for very many very short loops: a run costs little more than a microsecond when the threads are awake. Each
// thread begins with a stretch of its own, always the same one, so that what it wrote in one run is near when the next
// reads it; whoever is done helps the others. A thread that the system keeps waiting is not waited for unless it has
// begun. One thread at a time may call run.
class Pool {
  public:
    using Body = void (*)(const void* context, std::uint32_t begin, std::uint32_t end);

    explicit Pool(unsigned threads);  // the one that calls run is among them; throws std::system_error
    ~Pool();
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    [[nodiscard]] unsigned threads() const { return static_cast<unsigned>(workers_.size()) + 1; }

    // Calls `body` with ranges that together are 0 .. count - 1, of at most `grain` each but for the last; returns when
    // all have ended, and their writes are seen. A single range is done by the caller.
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

    // What is being run; written only while the gate is closed and nobody is inside.
    Body body_ = nullptr;
    const void* context_ = nullptr;
    std::uint32_t grain_ = 1;
    std::unique_ptr<Share[]> shares_;  // by thread

    // Bit 0: open; then the number of workers inside; from bit 32 on the number of the run.
    alignas(64) std::atomic<std::uint64_t> gate_ = 0;
    std::atomic<bool> stop_ = false;
    unsigned patience_ = 0;  // looks at the gate before a worker goes to sleep
    std::vector<std::jthread> workers_;
};

}  // namespace spherule::compute::cpu
