#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compute/gl/context.h"
#include "compute/gl/egl_devices.h"
#include "core/result.h"

namespace spherule::compute::gl {

// What `--device` asks for.
struct Wish {
    enum class Kind { Auto, Gpu, Software };
    Kind kind = Kind::Auto;
    unsigned gpu = 0;       // place among the hardware devices, preferred first
    bool numbered = false;  // that one and no other
};

// Input for anything but "auto", "gpu", "gpu:N", "software". Auto is a GPU that nobody asked for by name.
Result<Wish> parseWish(const std::string& choice);

struct Opened {
    std::shared_ptr<Context> context;
    std::string kind;    // "gpu" or "software", by what the context turned out to be
    std::string reason;  // one sentence
};

// Opens what is asked for among `devices` (of eglDevices()); when EGL lists none, what Mesa gives without. NoDevice
// says what was tried and what to do.
Result<Opened> openContext(const Wish& wish, const std::vector<EglDevice>& devices);

}  // namespace spherule::compute::gl
