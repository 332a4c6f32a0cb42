#include "compute/probe.h"

#include <spdlog/fmt/fmt.h>

#include "compute/gl/device.h"
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

void choose(Probe& result, const gl::Wish& wish, const std::vector<gl::EglDevice>& devices) {
    const auto opened = gl::openContext(wish, devices);
    if (!opened) {
        result.problem = opened.error().text();
        return;
    }
    result.chosen = gl::GlDevice(*opened).info();
    result.limits = gl::queryLimits();
}

}  // namespace

Result<Probe> probe(const std::string& choice) {
    const auto wish = gl::parseWish(choice);
    if (!wish) return tl::unexpected(wish.error());
    Probe result;
    result.choice = choice;
    result.vendors = detail::eglVendors();
    if (const auto loaded = gl::loadEgl(); loaded) {
        result.clientExtensions = gl::clientExtensions();
        const auto devices = gl::eglDevices();
        unsigned gpus = 0;
        for (const auto& device : devices) {
            const auto name = device.software() ? std::string("software") : fmt::format("gpu:{}", gpus++);
            result.devices.push_back(probeDevice(device, name));
        }
        choose(result, *wish, devices);
    } else {
        result.problem = loaded.error().text();
    }
    result.hints = detail::hintsFor(result, detail::hostFacts());
    return result;
}

}  // namespace spherule::compute
