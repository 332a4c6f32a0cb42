#include "compute/gl/open_device.h"
#include "compute/cpu/device.h"
#include "compute/device.h"
#include "core/log.h"

namespace spherule::compute {

Result<std::unique_ptr<Device>> openDevice(const std::string& choice) {
    auto device = gl::openDevice(choice);
    if (!device && cpu::answersTo(choice)) device = cpu::openDevice(choice, device.error().message);
    if (!device) return device;
    spdlog::debug("device: {}; {}", (*device)->info().renderer, (*device)->info().reason);
    return device;
}

}  // namespace spherule::compute
