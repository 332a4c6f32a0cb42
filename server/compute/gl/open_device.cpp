#include "compute/gl/open_device.h"

#include "compute/gl/device.h"
#include "compute/gl/egl_api.h"

namespace spherule::compute::gl {

Result<std::unique_ptr<Device>> openDevice(const std::string& choice) {
    const auto wish = parseWish(choice);
    if (!wish) return tl::unexpected(wish.error());
    if (auto loaded = loadEgl(); !loaded) return tl::unexpected(loaded.error());
    auto opened = openContext(*wish, eglDevices());
    if (!opened) return tl::unexpected(opened.error());
    return std::make_unique<GlDevice>(*opened);
}

}  // namespace spherule::compute::gl
