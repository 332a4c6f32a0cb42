#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compute/device.h"

// Lists the compute devices of this host, and gives advice if one is missing or cannot be used.
namespace spherule::compute {

// A vendor file (glvnd), by which EGL finds a vendor's library.
struct ProbeVendor {
    std::string file;
    std::string library;
    std::string problem;  // why the library cannot be opened; empty if it can
};

struct ProbeDevice {
    unsigned index = 0;                    // in EGL's order
    std::string choice;                    // what to pass as --device: "gpu:0", "software"
    std::string name;                      // by EGL; may be empty
    std::string extensions;                // of the EGL device
    std::string drmFile;                   // may be empty
    std::optional<unsigned> cudaNumber{};  // of NVIDIA's devices
    std::string vendor;                    // of its EGL display
    std::string renderer;                  // GL_RENDERER; empty if the device cannot be used
    std::string problem;                   // why it cannot be used; empty if it can
};

// OpenGL limits that limit the size of a scene.
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
    std::string eglProblem;  // why there is no EGL; empty if there is
    std::string clientExtensions;
    std::vector<ProbeVendor> vendors;
    std::vector<ProbeDevice> devices;  // preferred first
    std::string choice;                // as requested
    std::optional<DeviceInfo> chosen;  // the device that openDevice() returned
    std::optional<Limits> limits;      // of the chosen device
    std::string problem;               // why no device could be opened
    std::vector<std::string> hints;
};

// Opens every device in turn, which takes a moment. `choice` as for openDevice. Input if `choice` is unknown; all other
// problems are part of the result.
Result<Probe> probe(const std::string& choice);

std::string probeText(const Probe& probe);  // several lines
std::string probeJson(const Probe& probe);  // one line

// The parts of a probe that need no device.
namespace detail {

struct HostFacts {
    enum class Place { Host, Container, Pod };
    Place place = Place::Host;
    bool nvidiaDriver = false;       // its kernel module, by /proc/driver/nvidia or /dev/nvidiactl
    bool nvidiaLibrary = false;      // libEGL_nvidia.so.0 can be opened, whether or not a vendor file names it
    bool migSlice = false;           // a part of a GPU
    std::string nvidiaCapabilities;  // NVIDIA_DRIVER_CAPABILITIES, empty if unset
    std::string vendorVariable;      // name of the set __EGL_VENDOR_LIBRARY_... variable, which replaces glvnd's search
    std::vector<std::string> unsearched;         // NVIDIA's vendor files in folders that EGL does not search
    std::vector<std::string> closedDrmFiles;     // files below /dev/dri without read and write permission
    std::vector<std::string> closedNvidiaFiles;  // the same for /dev/nvidia*
};

// Collects the facts. `root` contains dev, proc, usr, ...; environment variables are read from this process.
HostFacts hostFacts(const std::filesystem::path& root = "/");
// Returns advice for missing or unusable devices, most useful first. Each hint is a sentence with the problem, its
// place and a remedy. docs/troubleshooting.md lists all hints.
std::vector<std::string> hintsFor(const Probe& probe, const HostFacts& host);
// Returns why an NVIDIA driver offers no OpenGL; empty if nothing indicates an NVIDIA driver.
std::string nvidiaHint(const Probe& probe, const HostFacts& host);
std::vector<ProbeVendor> eglVendors();

}  // namespace detail
}  // namespace spherule::compute
