#pragma once

#include <cstddef>
#include <memory>

#include "compute/gl/context.h"

namespace spherule::compute::gl {

// Memory of the host that the device copies to or from, mapped permanently.
class Staging {
  public:
    enum class Direction { FromDevice, ToDevice };

    Staging(std::shared_ptr<Context> context, Direction direction);
    ~Staging();
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;

    // Makes room for `bytes`; growing discards the content. Returns false (and logs) if there is no memory or the
    // context is lost.
    [[nodiscard]] bool reserve(std::size_t bytes);

    [[nodiscard]] GLuint id() const { return id_; }
    [[nodiscard]] std::byte* data() const { return data_; }

  private:
    void release();

    std::shared_ptr<Context> context_;
    Direction direction_;
    GLuint id_ = 0;
    std::size_t bytes_ = 0;
    std::byte* data_ = nullptr;
};

}  // namespace spherule::compute::gl
