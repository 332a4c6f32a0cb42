#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compute/gl/context.h"
#include "compute/gl/egl_devices.h"
#include "core/result.h"

namespace spherule::compute::gl {

// The device that `--device` requests.
struct Wish {
    enum class Kind { Auto, Gpu, Software };
    Kind kind = Kind::Auto;
    std::optional<unsigned> gpu{};   // only the device at this place among the hardware devices, preferred first
    std::optional<unsigned> cuda{};  // only NVIDIA's device with this CUDA number
};

// Parses `choice`. Input if it is not "auto", "gpu", "gpu:N", "gpu:cuda:N" or "software". "auto" means a GPU, like
// "gpu", but errors contain no advice.
Result<Wish> parseWish(const std::string& choice);

struct Opened {
    std::shared_ptr<Context> context;
    std::string kind;    // "gpu" or "software", according to the renderer
    std::string reason;  // one sentence
};

// Opens the requested device among `devices` (from eglDevices()). Without a number, the variable CUDA_VISIBLE_DEVICES
// counts. If EGL lists none, opens the device that Mesa chooses. The error NoDevice lists the attempts and a remedy.
Result<Opened> openContext(const Wish& wish, const std::vector<EglDevice>& devices);

}  // namespace spherule::compute::gl
