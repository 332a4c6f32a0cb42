#include "compute/probe.h"

#include <spdlog/fmt/fmt.h>

#include "compute/gl/context.h"
#include "compute/gl/egl_api.h"
#include "compute/gl/limits.h"

namespace spherule::compute {
namespace {

ProbeDevice probeDevice(const gl::EglDevice& device, const std::string& choice) {
    ProbeDevice result;
    result.index = device.index;
    result.choice = choice;
    result.name = device.name;
    result.extensions = device.extensions;
    result.drmFile = device.drmFile;
    result.cudaNumber = device.cudaNumber;
    const auto display = gl::EglDisplay::forDevice(device);
    if (!display) {
        result.problem = display.error().message;
        return result;
    }
    result.vendor = (*display)->vendor();
    const auto context = gl::Context::create(*display);
    if (context) {
        result.renderer = (*context)->renderer();
    } else {
        result.problem = context.error().message;
    }
    return result;
}

// queryLimits() reads the current context, which openDevice() has just made current.
Result<void> choose(Probe& result) {
    const auto opened = openDevice(result.choice);
    if (opened) {
        result.chosen = (*opened)->info();
        if (result.chosen->kind != "cpu") result.limits = gl::queryLimits();
    } else if (opened.error().kind == ErrorKind::Input) {
        return tl::unexpected(opened.error());
    } else {
        result.problem = opened.error().text();
    }
    return {};
}

}  // namespace

Result<Probe> probe(const std::string& choice) {
    Probe result;
    result.choice = choice;
    if (auto chosen = choose(result); !chosen) return tl::unexpected(chosen.error());
    result.vendors = detail::eglVendors();
    if (const auto loaded = gl::loadEgl(); loaded) {
        result.clientExtensions = gl::clientExtensions();
        unsigned gpus = 0;
        for (const auto& device : gl::eglDevices()) {
            const auto name = device.software() ? std::string("software") : fmt::format("gpu:{}", gpus++);
            result.devices.push_back(probeDevice(device, name));
        }
    } else {
        result.eglProblem = loaded.error().text();
    }
    result.hints = detail::hintsFor(result, detail::hostFacts());
    return result;
}

}  // namespace spherule::compute
