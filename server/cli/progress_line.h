#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdio>

#include <fmt/format.h>

namespace spherule::cli {

// A progress line on the terminal, rewritten a few times a second. Prints nothing if stderr is not a terminal.
class ProgressLine {
  public:
    ProgressLine() : shown_(isatty(STDERR_FILENO) != 0) {}
    ~ProgressLine() {
        if (printed_) std::fputc('\n', stderr);
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // Prints the line that `words` returns, but calls it at most every 200 ms.
    template <class Words>
    void show(Words words) {
        const auto now = Clock::now();
        if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
        last_ = now;
        printed_ = true;
        fmt::print(stderr, "\r{}", words());
    }

  private:
    using Clock = std::chrono::steady_clock;
    bool shown_;
    bool printed_ = false;
    Clock::time_point last_ = Clock::now();
};

}  // namespace spherule::cli
