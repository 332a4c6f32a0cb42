// The hints of the probe for each missing part of a host. docs/troubleshooting.md must contain them.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "compute/probe.h"

namespace spherule::compute::detail {
namespace {

const std::string troubleshooting = [] {
    std::ifstream file(SPHERULE_DOCS "/troubleshooting.md");
    return std::string(std::istreambuf_iterator<char>(file), {});
}();

ProbeDevice device(const std::string& choice, const std::string& extensions = "") {
    ProbeDevice result;
    result.choice = choice;
    result.extensions = extensions;
    return result;
}

// A host with a working software renderer and no other device.
Probe withSoftware(std::vector<ProbeVendor> vendors = {}) {
    Probe seen;
    seen.devices = {device("software")};
    seen.vendors = std::move(vendors);
    return seen;
}

HostFacts withNvidia() {
    HostFacts host;
    host.nvidiaDriver = true;
    return host;
}

const ProbeVendor nvidia{"/usr/share/glvnd/egl_vendor.d/10_nvidia.json", "libEGL_nvidia.so.0", ""};

// Checks the number of hints. The first must contain `part`, and docs/troubleshooting.md must contain it word for word.
void expectHint(const Probe& seen, const HostFacts& host, const std::string& part, std::size_t hints = 1) {
    const auto said = hintsFor(seen, host);
    ASSERT_EQ(said.size(), hints) << testing::PrintToString(said);
    EXPECT_NE(said.front().find(part), std::string::npos) << said.front();
    EXPECT_EQ(said.front().find(". "), std::string::npos) << "one sentence: " << said.front();
    EXPECT_TRUE(said.front().ends_with('.')) << said.front();
    EXPECT_NE(troubleshooting.find(said.front()), std::string::npos) << "not in the document: " << said.front();
}

TEST(ProbeHints, AreEmptyForCompleteHost) {
    Probe seen = withSoftware({nvidia});
    seen.devices.push_back(device("gpu:0", "EGL_NV_device_cuda"));
    HostFacts host = withNvidia();
    host.closedDrmFiles = {"/dev/dri/renderD128"};
    EXPECT_TRUE(hintsFor(seen, host).empty());
}

TEST(ProbeHints, AdviseToInstallEgl) {
    Probe seen = withSoftware();
    seen.eglProblem = "libEGL.so.1: cannot be opened";
    expectHint(seen, {}, "apt install libegl1");
    expectHint(seen, withNvidia(), "apt install libegl1");
}

TEST(ProbeHints, AdviseWhereToRequestGpu) {
    HostFacts host;
    expectHint(withSoftware(), host, "install its driver");
    host.place = HostFacts::Place::Container;
    expectHint(withSoftware(), host, "--gpus all");
    host.place = HostFacts::Place::Pod;
    expectHint(withSoftware(), host, "runtimeClassName");
}

TEST(ProbeHints, ReportContainerWithoutGraphics) {
    HostFacts host = withNvidia();
    host.nvidiaCapabilities = "compute,utility";
    expectHint(withSoftware(), host, "NVIDIA_DRIVER_CAPABILITIES=compute,utility,graphics");
    host.nvidiaCapabilities = "all";
    EXPECT_EQ(nvidiaHint(withSoftware({nvidia}), host).find("got only its parts"), std::string::npos);
}

TEST(ProbeHints, AdviseToCreateMissingVendorFile) {
    HostFacts host = withNvidia();
    host.nvidiaLibrary = true;
    expectHint(withSoftware(), host, "create /usr/share/glvnd/egl_vendor.d/10_nvidia.json");
}

TEST(ProbeHints, ReportDriverWithoutOpenGl) {
    expectHint(withSoftware(), withNvidia(), "neither a vendor file for EGL nor libEGL_nvidia.so.0");
    ProbeVendor gone = nvidia;
    gone.problem = "libEGL_nvidia.so.0: cannot open shared object file: No such file or directory";
    expectHint(withSoftware({gone}), withNvidia(), "names libEGL_nvidia.so.0, which is not here");
}

TEST(ProbeHints, ReportVendorFileOutsideSearchPath) {
    HostFacts host = withNvidia();
    host.unsearched = {"/run/opengl-driver/share/glvnd/egl_vendor.d/10_nvidia.json"};
    expectHint(withSoftware(), host, "where EGL does not look");
    host.unsearched = {"/usr/share/glvnd/egl_vendor.d/10_nvidia.json"};
    host.vendorVariable = "__EGL_VENDOR_LIBRARY_FILENAMES";
    expectHint(withSoftware(), host, "because __EGL_VENDOR_LIBRARY_FILENAMES is set and names others");
}

TEST(ProbeHints, NameSkippedLibraryAndWhatItLacks) {
    ProbeVendor broken = nvidia;
    broken.problem = "libnvidia-glsi.so.535.183.01: cannot open shared object file: No such file or directory";
    expectHint(withSoftware({broken}), withNvidia(),
               "because libnvidia-glsi.so.535.183.01, which it needs, is missing");
    broken.problem = "libEGL_nvidia.so.0: invalid ELF header";
    expectHint(withSoftware({broken}), withNvidia(), "it does not open (libEGL_nvidia.so.0: invalid ELF header)");
}

TEST(ProbeHints, ReportMigSlice) {
    HostFacts host = withNvidia();
    host.migSlice = true;
    expectHint(withSoftware({nvidia}), host, "MIG slice");
}

TEST(ProbeHints, NameInaccessibleFiles) {
    HostFacts host = withNvidia();
    host.closedNvidiaFiles = {"/dev/nvidia0", "/dev/nvidiactl"};
    expectHint(withSoftware({nvidia}), host, "You may not open /dev/nvidia0, /dev/nvidiactl");
    HostFacts drm;
    drm.closedDrmFiles = {"/dev/dri/renderD128"};
    expectHint(withSoftware(), drm, "You may not open /dev/dri/renderD128");
}

TEST(ProbeHints, ReportDriverWithoutGpu) {
    expectHint(withSoftware({nvidia}), withNvidia(), "nvidia-smi");
}

TEST(ProbeHints, ReportMissingKernelModule) {
    HostFacts host;
    expectHint(withSoftware({nvidia}), host, "modprobe nvidia");
    host.place = HostFacts::Place::Container;
    expectHint(withSoftware({nvidia}), host, "no GPU was given to this container");
    host.place = HostFacts::Place::Pod;
    expectHint(withSoftware({nvidia}), host, "no GPU was given to this pod");
}

TEST(ProbeHints, ReportMissingSoftwareRendererLast) {
    Probe seen;
    seen.devices = {device("gpu:0")};
    expectHint(seen, {}, "libgl1-mesa-dri");
    seen.devices.clear();
    const auto said = hintsFor(seen, {});
    ASSERT_EQ(said.size(), 2U);
    EXPECT_NE(said.back().find("libgl1-mesa-dri"), std::string::npos);
}

TEST(ProbeHints, ReportDriverWithoutResetStatus) {
    Probe seen = withSoftware();
    seen.chosen.emplace();
    seen.chosen->kind = "gpu";
    expectHint(seen, {}, "does not report a reset");
}

}  // namespace
}  // namespace spherule::compute::detail
