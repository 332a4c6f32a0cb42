#pragma once

#include <array>
#include <deque>
#include <memory>

#include "compute/device.h"
#include "compute/gl/context.h"
#include "compute/gl/staging.h"

namespace spherule::compute::gl {

class GlWordQueue final : public WordQueue {
  public:
    explicit GlWordQueue(std::shared_ptr<Context> context);
    ~GlWordQueue() override;
    GlWordQueue(const GlWordQueue&) = delete;
    GlWordQueue& operator=(const GlWordQueue&) = delete;

    void start(const Buffer& buffer, std::size_t offset) override;
    [[nodiscard]] std::size_t underWay() const override { return fences_.size(); }
    std::uint32_t take() override;

  private:
    std::shared_ptr<Context> context_;
    Staging staging_;
    std::size_t next_ = 0;       // place of the next word in `staging_`
    std::deque<GLsync> fences_;  // of the words under way
};

}  // namespace spherule::compute::gl
