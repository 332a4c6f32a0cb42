#pragma once

#include <array>
#include <memory>
#include <vector>

#include "compute/gl/context.h"

namespace spherule::compute::gl {

// Sums of device time between pairs of timestamps, by slot. The context must be current in every call.
class Timers {
  public:
    explicit Timers(std::shared_ptr<Context> context);
    ~Timers();
    Timers(const Timers&) = delete;
    Timers& operator=(const Timers&) = delete;

    void begin(unsigned slot);
    void end();

    // Returns the time (s) by slot since the last call. Waits for the device.
    std::vector<double> take();

  private:
    struct Span {
        unsigned slot = 0;
        GLuint begin = 0, end = 0;  // timestamp queries
    };

    Span takeSpan(unsigned slot);
    void collectArrived();
    void add(const Span& span);

    std::shared_ptr<Context> context_;
    std::vector<Span> pending_;  // in order of time
    std::vector<Span> free_;
    std::vector<double> seconds_;
    bool running_ = false;
};

}  // namespace spherule::compute::gl
