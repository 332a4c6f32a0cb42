#pragma once

#include <array>
#include <memory>

#include "compute/device.h"
#include "compute/gl/staging.h"

namespace spherule::compute::gl {

// The two staging buffers for copies to the host. Lives until the device and the last copy are gone.
class ReadBackPlaces : public std::enable_shared_from_this<ReadBackPlaces> {
  public:
    explicit ReadBackPlaces(const std::shared_ptr<Context>& context);

    // Starts copying the first `bytes` of `source`. Returns nullptr if both places are taken or there is no memory.
    std::unique_ptr<ReadBack> start(GLuint source, std::size_t bytes);

  private:
    friend class GlReadBack;
    struct Place {
        Staging staging;
        bool taken = false;
    };

    std::shared_ptr<Context> context_;
    std::array<Place, 2> places_;
};

}  // namespace spherule::compute::gl
