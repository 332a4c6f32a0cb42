#include <algorithm>

#include <spdlog/fmt/fmt.h>

#include "compute/probe.h"

namespace spherule::compute::detail {
namespace {

bool usable(const ProbeDevice& device) {
    return device.problem.empty();
}

// Returns the hint for a host on which nothing indicates a GPU.
std::string noGpu(const HostFacts& host) {
    constexpr const char* meanwhile = "until then scenes run on the CPU";
    switch (host.place) {
        case HostFacts::Place::Pod:
            return fmt::format(
                "No GPU is in this pod: ask for resources.limits nvidia.com/gpu: 1, and set runtimeClassName: "
                "nvidia where that runtime is not the default; {}.",
                meanwhile);
        case HostFacts::Place::Container:
            return fmt::format(
                "No GPU is in this container: start it with --gpus all (NVIDIA) or --device /dev/dri (AMD, "
                "Intel); {}.",
                meanwhile);
        case HostFacts::Place::Host:
            break;
    }
    return fmt::format("No GPU was found here: if the machine has one, install its driver; {}.", meanwhile);
}

}  // namespace

std::vector<std::string> hintsFor(const Probe& probe, const HostFacts& host) {
    std::vector<std::string> hints;
    const auto any = [&](auto predicate) { return std::any_of(probe.devices.begin(), probe.devices.end(), predicate); };
    const bool gpu = any([](const auto& d) { return usable(d) && d.choice != "software"; }) ||
                     (probe.chosen && probe.chosen->kind == "gpu");
    const bool software = any([](const auto& d) { return usable(d) && d.choice == "software"; }) ||
                          (probe.chosen && probe.chosen->kind == "software");
    const bool nvidiaUsed =
        any([](const auto& d) { return usable(d) && d.extensions.find("EGL_NV_device_cuda") != std::string::npos; });
    if (!probe.eglProblem.empty()) {
        hints.emplace_back(
            "There is no EGL on this host (libEGL.so.1), by which a GPU is reached without a display: install it (on "
            "Debian: apt install libegl1).");
    } else if (!nvidiaUsed) {
        if (auto hint = nvidiaHint(probe, host); !hint.empty()) hints.push_back(std::move(hint));
    }
    if (!gpu && !host.closedDrmFiles.empty()) {
        hints.push_back(fmt::format(
            "You may not open {}: join its group (on Debian: adduser $USER render) and log in anew, or run the "
            "container with that group.",
            fmt::join(host.closedDrmFiles, ", ")));
    }
    if (!gpu && hints.empty()) hints.push_back(noGpu(host));
    if (!software) {
        hints.emplace_back(
            "Mesa's software renderer is not here, which only tests need: install it (on Debian: apt install libegl1 "
            "libegl-mesa0 libgl1-mesa-dri).");
    }
    if (probe.chosen && !probe.chosen->robust) {
        hints.emplace_back(
            "The chosen driver does not report a reset, so that a lost GPU is noticed by the watchdog only: a newer "
            "driver "
            "may.");
    }
    return hints;
}

}  // namespace spherule::compute::detail
