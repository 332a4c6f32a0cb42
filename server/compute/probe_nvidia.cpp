#include <algorithm>

#include <spdlog/fmt/fmt.h>

#include "compute/probe.h"

namespace spherule::compute::detail {
namespace {

constexpr const char* wholeDriver =
    "install its OpenGL part (on Debian: apt install libegl-nvidia0), or start the container with "
    "NVIDIA_DRIVER_CAPABILITIES=compute,utility,graphics";

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// Returns the file that the loader did not find: the library itself, or a library that it needs. Empty if the loader
// failed for another reason.
std::string missingFile(const std::string& problem) {
    const auto end = problem.find(": cannot open shared object file");
    return end == std::string::npos ? "" : problem.substr(0, end);
}

std::string nothingNamesIt(const HostFacts& host) {
    if (!host.unsearched.empty() && !host.vendorVariable.empty())
        return fmt::format(
            "EGL does not see NVIDIA's vendor file {}, because {} is set and names others: unset it, or add "
            "that file.",
            host.unsearched.front(), host.vendorVariable);
    if (!host.unsearched.empty())
        return fmt::format(
            "NVIDIA's vendor file is at {}, where EGL does not look: name it in "
            "__EGL_VENDOR_LIBRARY_FILENAMES.",
            host.unsearched.front());
    if (host.nvidiaLibrary)
        return "NVIDIA's libEGL_nvidia.so.0 is here, but no vendor file names it to EGL: create "
               "/usr/share/glvnd/egl_vendor.d/10_nvidia.json with "
               R"({"file_format_version":"1.0.0","ICD":{"library_path":"libEGL_nvidia.so.0"}}.)";
    return fmt::format("An NVIDIA driver is here, but neither a vendor file for EGL nor libEGL_nvidia.so.0: {}.",
                       wholeDriver);
}

std::string libraryFails(const ProbeVendor& vendor) {
    const std::string missing = missingFile(vendor.problem);
    if (missing == vendor.library)
        return fmt::format("The vendor file {} names {}, which is not here: {}.", vendor.file, vendor.library,
                           wholeDriver);
    if (!missing.empty())
        return fmt::format(
            "EGL skips NVIDIA's {} silently, because {}, which it needs, is missing: install that "
            "part of the driver, or mount it into the container.",
            vendor.library, missing);
    return fmt::format("EGL skips NVIDIA's {} silently, because it does not open ({}): install the driver again.",
                       vendor.library, vendor.problem);
}

std::string noKernelModule(const HostFacts& host) {
    switch (host.place) {
        case HostFacts::Place::Pod:
            return "NVIDIA's EGL library is here, but no GPU was given to this pod: ask for resources.limits "
                   "nvidia.com/gpu: 1, and set runtimeClassName: nvidia where that runtime is not the default.";
        case HostFacts::Place::Container:
            return "NVIDIA's EGL library is here, but no GPU was given to this container: start it with --gpus all.";
        case HostFacts::Place::Host:
            break;
    }
    return "NVIDIA's EGL library is here, but its kernel module is not loaded (/dev/nvidiactl is not there): install "
           "the "
           "driver for this kernel, or load it with modprobe nvidia.";
}

}  // namespace

std::string nvidiaHint(const Probe& probe, const HostFacts& host) {
    const auto vendor = std::find_if(probe.vendors.begin(), probe.vendors.end(),
                                     [](const auto& v) { return contains(v.library, "nvidia"); });
    const bool named = vendor != probe.vendors.end();
    if (!host.nvidiaDriver) return (named && vendor->problem.empty()) ? noKernelModule(host) : "";
    const auto& capabilities = host.nvidiaCapabilities;
    if (!capabilities.empty() && !contains(capabilities, "graphics") && !contains(capabilities, "all")) {
        return fmt::format(
            "An NVIDIA driver is here, but this container got only its parts \"{}\": start it with "
            "NVIDIA_DRIVER_CAPABILITIES=compute,utility,graphics.",
            capabilities);
    }
    if (!named) return nothingNamesIt(host);
    if (!vendor->problem.empty()) return libraryFails(*vendor);
    if (host.migSlice)
        return "This is a MIG slice of an NVIDIA GPU, which offers no OpenGL: use the whole GPU, or --device cpu.";
    if (!host.closedNvidiaFiles.empty())
        return fmt::format("You may not open {}: join the group that owns it, or run the container with that group.",
                           fmt::join(host.closedNvidiaFiles, ", "));
    return "An NVIDIA driver is here and EGL loads it, but it gives no GPU: see whether nvidia-smi lists one, and "
           "whether "
           "NVIDIA_VISIBLE_DEVICES hides it.";
}

}  // namespace spherule::compute::detail
