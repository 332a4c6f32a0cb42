#pragma once

#include <cstddef>
#include <memory>

#include "compute/gl/context.h"

namespace spherule::compute::gl {

// Memory that the device writes and the host reads, mapped permanently.
class Staging {
  public:
    explicit Staging(std::shared_ptr<Context> context);
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    // Makes room for `bytes`; growing discards the content. Returns false (and logs) if there is no memory or the
    // context is lost.
    [[nodiscard]] bool reserve(std::size_t bytes);

    [[nodiscard]] GLuint id() const { return id_; }
    [[nodiscard]] const std::byte* data() const { return data_; }

  private:
    void release();

    std::shared_ptr<Context> context_;
    GLuint id_ = 0;
    std::size_t bytes_ = 0;
    const std::byte* data_ = nullptr;
};

}  // namespace spherule::compute::gl
