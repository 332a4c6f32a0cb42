#include <iterator>

#include <spdlog/fmt/fmt.h>

#include "compute/probe.h"

namespace spherule::compute {
namespace {

const char* orNone(const std::string& text) {
    return text.empty() ? "none" : text.c_str();
}

std::string chosenText(const DeviceInfo& info) {
    return fmt::format(
        "  renderer      {}\n  vendor        {}\n  version       {}\n  why           {}\n"
        "  reports loss  {}\n",
        info.renderer, info.vendor, info.version, info.reason, info.robust ? "yes" : "no");
}

std::string limitsText(const Limits& limits) {
    return fmt::format(
        "  one buffer          {} bytes ({:.0f} MiB)\n"
        "  buffers per kernel  {} of {} bindings\n"
        "  uniform block       {} bytes\n"
        "  groups              {} x {} of up to {} invocations\n"
        "  shared memory       {} bytes\n"
        "  subgroups           {} (not needed)\n",
        limits.maxBufferBytes, static_cast<double>(limits.maxBufferBytes) / (1 << 20), limits.storageBuffersPerKernel,
        limits.storageBindings, limits.uniformBlockBytes, limits.groupsX, limits.groupsY, limits.groupInvocations,
        limits.sharedBytes, limits.subgroups ? "yes" : "no");
}

std::string deviceText(const ProbeDevice& device) {
    const auto state = device.problem.empty() ? device.renderer : "cannot be used: " + device.problem;
    return fmt::format(
        "  {:<10}  {}\n              EGL device {}, name {}, vendor {}, DRM file {}{}\n"
        "              extensions {}\n",
        device.choice, state, device.index, orNone(device.name), orNone(device.vendor), orNone(device.drmFile),
        device.cudaNumber ? fmt::format(", gpu:cuda:{}", *device.cudaNumber) : "", orNone(device.extensions));
}

std::string vendorText(const ProbeVendor& vendor) {
    return fmt::format("  {}  {}  {}\n", vendor.file, vendor.library,
                       vendor.problem.empty() ? "opens" : vendor.problem);
}

}  // namespace

std::string probeText(const Probe& probe) {
    std::string text = fmt::format("Chosen by --device {}\n", probe.choice);
    text += probe.chosen ? chosenText(*probe.chosen) : fmt::format("  nothing: {}\n", probe.problem);
    if (probe.limits) text += "Limits of OpenGL on it\n" + limitsText(*probe.limits);
    text += "Devices of EGL, preferred first; besides them there is cpu\n";
    for (const auto& device : probe.devices) text += deviceText(device);
    if (probe.devices.empty()) text += "  EGL lists none\n";
    text += "EGL vendors\n";
    for (const auto& vendor : probe.vendors) text += vendorText(vendor);
    if (probe.vendors.empty()) text += "  no vendor file\n";
    text += fmt::format("EGL client extensions\n  {}\n", orNone(probe.clientExtensions));
    if (!probe.hints.empty()) text += "Hints\n";
    for (const auto& hint : probe.hints) text += fmt::format("  {}\n", hint);
    return text;
}

}  // namespace spherule::compute
