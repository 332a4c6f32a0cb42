#pragma once

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdint>

#include <ucontext.h>

namespace spherule::instruments {

// The threads of a work group, each with a stack. One of them runs at a time, until it waits or ends.
class Threads {
  public:
    static constexpr std::uint32_t count = 64;

    // `memory`: count * stackBytes bytes, which outlive the object.
    static constexpr std::size_t stackBytes = std::size_t{256} << 10U;
    explicit Threads(std::byte* memory);
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    // Lets every thread begin anew: resume() calls `body(context, thread)`.
    void begin(void (*body)(const void* context, std::uint32_t thread), const void* context);

    // Runs the thread until it calls wait() or its body returns.
    void resume(std::uint32_t thread);
    [[nodiscard]] bool ended(std::uint32_t thread) const { return ended_[thread]; }

    // Called by the thread that runs: returns at its next resume().
    void wait();

  private:
    void start(const ucontext_t& context);
    static void enter(unsigned high, unsigned low, unsigned thread);
    [[noreturn]] void loop(std::uint32_t thread);
    void leave(std::uint32_t thread);

    std::jmp_buf outside_{};
    std::array<std::jmp_buf, count> inside_{};
    std::array<bool, count> ended_{};
    std::uint32_t running_ = 0;
    void (*body_)(const void*, std::uint32_t) = nullptr;
    const void* context_ = nullptr;
};

}  // namespace spherule::instruments
