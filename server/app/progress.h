#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdio>

#include <fmt/format.h>

namespace spherule::app {

// A line on the terminal that is rewritten a few times a second; silent elsewhere.
class ProgressLine {
  public:
    ProgressLine() : shown_(isatty(STDERR_FILENO) != 0) {}
    ~ProgressLine() {
        if (printed_) std::fputc('\n', stderr);
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // `words` gives the line, where it is time for one.
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

}  // namespace spherule::app
