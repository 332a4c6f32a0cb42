#pragma once

#include <cstdint>
#include <filesystem>
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
    std::string eglProblem;  // why there is no EGL at all; empty where there is
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
    enum class Place { Host, Container, Pod };
    Place place = Place::Host;
    bool nvidiaDriver = false;                // its kernel module, by /proc/driver/nvidia or /dev/nvidiactl
    bool nvidiaLibrary = false;               // libEGL_nvidia.so.0 can be opened, whether or not a vendor file names it
    bool migSlice = false;                    // a part of a GPU
    std::string nvidiaCapabilities;           // NVIDIA_DRIVER_CAPABILITIES, empty when unset
    std::string vendorVariable;               // __EGL_VENDOR_LIBRARY_..., which is set and replaces glvnd's own search
    std::vector<std::string> unsearched;      // NVIDIA's vendor files where EGL does not look
    std::vector<std::string> closedDrmFiles;  // below /dev/dri, not ours to open
    std::vector<std::string> closedNvidiaFiles;  // /dev/nvidia*, the same
};

// Below `root` lie dev, proc, usr, ...; the environment is that of this process.
HostFacts hostFacts(const std::filesystem::path& root = "/");
// What to do about what is missing, most useful first: each a sentence that says what, where and what to do.
// docs/troubleshooting.md has them all.
std::vector<std::string> hintsFor(const Probe& probe, const HostFacts& host);
// Why an NVIDIA driver that is here, or was here, gives no OpenGL; empty where nothing points to one.
std::string nvidiaHint(const Probe& probe, const HostFacts& host);
std::vector<ProbeVendor> eglVendors();

}  // namespace detail
}  // namespace spherule::compute
