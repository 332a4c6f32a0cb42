#pragma once

#include <deque>
#include <memory>

#include "compute/gl/context.h"

namespace spherule::compute::gl {

// Waits for a fence, or until the context is lost. The context must be current.
void waitFor(Context& context, GLsync fence);

// Waits for the device. Sends a heartbeat (core/heartbeat.h) for each part of the work that has ended, so that a wait
// may be long while the device makes progress.
class Fences {
  public:
    explicit Fences(std::shared_ptr<Context> context);
    ~Fences();
    Fences(const Fences&) = delete;
    Fences& operator=(const Fences&) = delete;

    // Call after each launch. The context must be current. Waits if the device has much work pending.
    void launched();
    // Waits until all work of the device has ended, or the device is lost. The context must be current.
    void wait();

  private:
    void add();
    void waitForFirst();

    std::shared_ptr<Context> context_;
    std::deque<GLsync> fences_;
    unsigned launches_ = 0;  // since the last fence
};

}  // namespace spherule::compute::gl
