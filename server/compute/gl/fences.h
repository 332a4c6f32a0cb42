#pragma once

#include <deque>
#include <memory>

#include "compute/gl/context.h"

namespace spherule::compute::gl {

// Waits for the device, with a sign of life (core/heartbeat.h) for each part of the work that has ended: a wait may be
// long, as long as something moves.
class Fences {
  public:
    explicit Fences(std::shared_ptr<Context> context);
    ~Fences();
    Fences(const Fences&) = delete;
    Fences& operator=(const Fences&) = delete;

    // After each launch. The context is current. Waits where the device has much to do already.
    void launched();
    // Until all that was asked of the device has ended, or it is lost. The context is current.
    void wait();

  private:
    void add();
    void waitForFirst();

    std::shared_ptr<Context> context_;
    std::deque<GLsync> fences_;
    unsigned launches_ = 0;  // since the last of them
};

}  // namespace spherule::compute::gl
