#include "compute/gl/open_device.h"
#include "compute/cpu/device.h"
#include "compute/device.h"
#include "core/log.h"

namespace spherule::compute {

Result<std::unique_ptr<Device>> openDevice(const std::string& choice) {
    auto device =
        choice.starts_with("cpu") ? cpu::openDevice(choice, "asked for as " + choice) : gl::openDevice(choice);
    if (!device && choice == "auto") device = cpu::openDevice("cpu", device.error().message);
    if (!device) return device;
    spdlog::debug("device: {}; {}", (*device)->info().renderer, (*device)->info().reason);
    return device;
}

}  // namespace spherule::compute
