#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compute/device.h"

// What this host offers to compute on, and what to do about what is missing.
namespace spherule::compute {

// A file that tells EGL of a vendor's library (glvnd).
struct ProbeVendor {
    std::string file;
    std::string library;
    std::string problem;  // why the library does not open; empty when it does
};

struct ProbeDevice {
    unsigned index = 0;      // in EGL's order
    std::string choice;      // what to pass as --device: "gpu:0", "software"
    std::string name;        // as EGL has it; may be empty
    std::string extensions;  // of the EGL device
    std::string drmFile;     // may be empty
    std::string vendor;      // of its EGL display
    std::string renderer;    // GL_RENDERER; empty when it cannot be used
    std::string problem;     // why it cannot be used; empty when it can
};

// OpenGL's limits that bound a scene.
struct Limits {
    std::int64_t maxBufferBytes = 0;  // one storage buffer
    std::int64_t storageBuffersPerKernel = 0;
    std::int64_t storageBindings = 0;
    std::int64_t uniformBlockBytes = 0;
    std::int64_t groupsX = 0, groupsY = 0;  // of one launch
    std::int64_t groupInvocations = 0;
    std::int64_t sharedBytes = 0;  // of one group
    bool subgroups = false;        // not needed
};

struct Probe {
    std::string clientExtensions;
    std::vector<ProbeVendor> vendors;
    std::vector<ProbeDevice> devices;  // preferred first
    std::string choice;                // what was asked for
    std::optional<DeviceInfo> chosen;  // what it gives
    std::optional<Limits> limits;      // of the chosen device
    std::string problem;               // why nothing could be chosen
    std::vector<std::string> hints;
};

// Opens every device in turn, so it takes a moment. `choice` as for openDevice. Input for an unknown choice; all else
// that is wrong is in the result.
Result<Probe> probe(const std::string& choice);

std::string probeText(const Probe& probe);  // several lines
std::string probeJson(const Probe& probe);  // one line

// The parts of a probe that need no device.
namespace detail {

struct HostFacts {
    bool nvidiaKernelModule = false;          // /proc/driver/nvidia or /dev/nvidiactl
    std::string nvidiaCapabilities;           // NVIDIA_DRIVER_CAPABILITIES, empty when unset
    std::vector<std::string> closedDrmFiles;  // below /dev/dri, not ours to open
};

HostFacts hostFacts();
std::vector<std::string> hintsFor(const Probe& probe, const HostFacts& host);
std::vector<ProbeVendor> eglVendors();

}  // namespace detail
}  // namespace spherule::compute
