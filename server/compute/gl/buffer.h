#pragma once

#include <memory>
#include <string_view>

#include "compute/device.h"
#include "compute/gl/context.h"

namespace spherule::compute::gl {

// Device memory. Its size is rounded up to a whole vec4, so that a kernel may read whole vec4s.
class GlBuffer final : public Buffer {
  public:
    // Refused, with the sizes, if the driver has no room.
    static Result<std::unique_ptr<Buffer>> create(const std::shared_ptr<Context>& context, std::string_view label,
                                                  std::size_t bytes);
    ~GlBuffer() override;
    GlBuffer(const GlBuffer&) = delete;
    GlBuffer& operator=(const GlBuffer&) = delete;

    [[nodiscard]] std::size_t bytes() const override { return bytes_; }
    [[nodiscard]] GLuint id() const { return id_; }

  private:
    GlBuffer(std::shared_ptr<Context> context, std::size_t bytes);

    std::shared_ptr<Context> context_;
    std::size_t bytes_;
    GLuint id_ = 0;
};

}  // namespace spherule::compute::gl
