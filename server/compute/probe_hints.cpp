#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <spdlog/fmt/fmt.h>

#include "compute/probe.h"

namespace spherule::compute::detail {
namespace {

namespace fs = std::filesystem;

bool contains(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

bool usable(const ProbeDevice& device) {
    return device.problem.empty();
}

// Why an NVIDIA driver that is there gives no OpenGL, by what is most often missing.
std::string nvidiaHint(const Probe& probe, const HostFacts& host) {
    const auto& capabilities = host.nvidiaCapabilities;
    if (!capabilities.empty() && !contains(capabilities, "graphics") && !contains(capabilities, "all")) {
        return fmt::format(
            "An NVIDIA driver is here, but this container got only its parts \"{}\": start it with "
            "NVIDIA_DRIVER_CAPABILITIES=compute,utility,graphics.",
            capabilities);
    }
    const auto vendor = std::find_if(probe.vendors.begin(), probe.vendors.end(),
                                     [](const auto& v) { return contains(v.library, "nvidia"); });
    if (vendor == probe.vendors.end()) {
        return "An NVIDIA driver is here, but no EGL vendor file names its library: create "
               "/usr/share/glvnd/egl_vendor.d/10_nvidia.json with "
               R"({"file_format_version":"1.0.0","ICD":{"library_path":"libEGL_nvidia.so.0"}}, )"
               "or name such a file in __EGL_VENDOR_LIBRARY_FILENAMES.";
    }
    if (!vendor->problem.empty()) {
        return fmt::format(
            "An NVIDIA driver is here, but {} does not open ({}): install the OpenGL part of the driver, "
            "or in a container start with NVIDIA_DRIVER_CAPABILITIES=compute,utility,graphics.",
            vendor->library, vendor->problem);
    }
    return "An NVIDIA driver is here, but gives no GPU to OpenGL: a MIG slice offers no OpenGL (use the whole GPU); "
           "else see whether nvidia-smi lists it and whether you may open /dev/nvidia*.";
}

}  // namespace

HostFacts hostFacts() {
    HostFacts facts;
    std::error_code none;
    facts.nvidiaKernelModule = fs::exists("/proc/driver/nvidia/version", none) || fs::exists("/dev/nvidiactl", none);
    if (const char* const capabilities = std::getenv("NVIDIA_DRIVER_CAPABILITIES")) {
        facts.nvidiaCapabilities = capabilities;
    }
    for (const auto& entry : fs::directory_iterator("/dev/dri", none)) {
        const auto path = entry.path().string();
        if (contains(path, "renderD") && access(path.c_str(), R_OK | W_OK) != 0) facts.closedDrmFiles.push_back(path);
    }
    std::sort(facts.closedDrmFiles.begin(), facts.closedDrmFiles.end());
    return facts;
}

std::vector<std::string> hintsFor(const Probe& probe, const HostFacts& host) {
    std::vector<std::string> hints;
    const auto any = [&](auto predicate) { return std::any_of(probe.devices.begin(), probe.devices.end(), predicate); };
    const bool gpu = any([](const auto& d) { return usable(d) && d.choice != "software"; }) ||
                     (probe.chosen && probe.chosen->kind == "gpu");
    const bool software = any([](const auto& d) { return usable(d) && d.choice == "software"; }) ||
                          (probe.chosen && probe.chosen->kind == "software");
    const bool nvidiaUsed =
        any([](const auto& d) { return usable(d) && contains(d.extensions, "EGL_NV_device_cuda"); });
    if (host.nvidiaKernelModule && !nvidiaUsed) hints.push_back(nvidiaHint(probe, host));
    if (!gpu && !host.closedDrmFiles.empty()) {
        hints.push_back(
            fmt::format("You may not open {}: join its group (on Debian: adduser $USER render) and log in "
                        "anew.",
                        fmt::join(host.closedDrmFiles, ", ")));
    }
    if (!gpu && hints.empty() && probe.chosen) {
        hints.emplace_back("No GPU was found. Scenes run on the CPU, with fewer spheres in real time than on a GPU.");
    }
    if (!software) {
        hints.emplace_back(
            "Mesa's software renderer is not here. Only tests need it (on Debian: apt install libegl1 libegl-mesa0 "
            "libgl1-mesa-dri).");
    }
    if (probe.chosen && !probe.chosen->robust) {
        hints.emplace_back(
            "The chosen driver does not report a reset: a hung kernel may end the program without a word.");
    }
    return hints;
}

}  // namespace spherule::compute::detail
