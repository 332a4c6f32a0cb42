#include "compute/device.h"
#include "compute/gl/device.h"
#include "compute/gl/egl_api.h"
#include "core/log.h"

namespace spherule::compute {

Result<std::unique_ptr<Device>> openDevice(const std::string& choice) {
    const auto wish = gl::parseWish(choice);
    if (!wish) return tl::unexpected(wish.error());
    if (auto loaded = gl::loadEgl(); !loaded) return tl::unexpected(loaded.error());
    auto opened = gl::openContext(*wish, gl::eglDevices());
    if (!opened) return tl::unexpected(opened.error());
    auto device = std::make_unique<gl::GlDevice>(*opened);
    spdlog::info("device: {}; {}", device->info().renderer, device->info().reason);
    return device;
}

}  // namespace spherule::compute
