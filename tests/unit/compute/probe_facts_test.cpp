// The facts that the probe reads from a host. Here the host is a folder with such files; some vendor files are invalid.
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "compute/probe.h"

namespace spherule::compute::detail {
namespace {

namespace fs = std::filesystem;

class ProbeFacts : public testing::Test {
  protected:
    ProbeFacts() { forget(); }
    ~ProbeFacts() override {
        forget();
        fs::remove_all(root_);
    }

    static void forget() {
        for (const char* const name :
             {"__EGL_VENDOR_LIBRARY_DIRS", "__EGL_VENDOR_LIBRARY_FILENAMES", "NVIDIA_DRIVER_CAPABILITIES",
              "NVIDIA_VISIBLE_DEVICES", "KUBERNETES_SERVICE_HOST"})
            unsetenv(name);
    }
    static void set(const char* name, const std::string& value) { setenv(name, value.c_str(), 1); }

    fs::path file(const std::string& path, const std::string& text = "") const {
        fs::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << text;
        return root_ / path;
    }
    [[nodiscard]] HostFacts facts() const { return hostFacts(root_); }

    static std::string vendorText(const std::string& library) {
        return R"({"file_format_version":"1.0.0","ICD":{"library_path":")" + library + R"("}})";
    }

    fs::path root_ = fs::temp_directory_path() / ("spherule_facts_" + std::to_string(getpid()));
};

TEST_F(ProbeFacts, AreEmptyOnEmptyHost) {
    const auto host = facts();
    EXPECT_EQ(host.place, HostFacts::Place::Host);
    EXPECT_FALSE(host.nvidiaDriver || host.migSlice);
    EXPECT_TRUE(host.unsearched.empty() && host.closedDrmFiles.empty() && host.closedNvidiaFiles.empty());
}

TEST_F(ProbeFacts, DetectNvidiaDriverByItsFiles) {
    file("dev/nvidiactl");
    EXPECT_TRUE(facts().nvidiaDriver);
    fs::remove_all(root_);
    file("proc/driver/nvidia/version");
    EXPECT_TRUE(facts().nvidiaDriver);
}

TEST_F(ProbeFacts, DetectMigSliceByNameOrCapability) {
    file("proc/driver/nvidia/capabilities/mig/config");  // exists if the driver supports MIG
    EXPECT_FALSE(facts().migSlice);
    file("proc/driver/nvidia/capabilities/gpu0/mig/gi7/access");
    EXPECT_TRUE(facts().migSlice);
    fs::remove_all(root_);
    set("NVIDIA_VISIBLE_DEVICES", "MIG-3d4e");
    EXPECT_TRUE(facts().migSlice);
}

TEST_F(ProbeFacts, DetectContainersAndPods) {
    file(".dockerenv");
    EXPECT_EQ(facts().place, HostFacts::Place::Container);
    fs::remove_all(root_);
    file("run/.containerenv");
    EXPECT_EQ(facts().place, HostFacts::Place::Container);
    set("KUBERNETES_SERVICE_HOST", "10.0.0.1");
    EXPECT_EQ(facts().place, HostFacts::Place::Pod);
}

TEST_F(ProbeFacts, FindVendorFilesThatEglDoesNotRead) {
    file("run/opengl-driver/share/glvnd/egl_vendor.d/10_nvidia.json");
    file("usr/share/glvnd/egl_vendor.d/10_nvidia.json");
    file("usr/share/glvnd/egl_vendor.d/50_mesa.json");
    EXPECT_EQ(facts().unsearched,
              std::vector<std::string>{"/run/opengl-driver/share/glvnd/egl_vendor.d/10_nvidia.json"});
    set("__EGL_VENDOR_LIBRARY_DIRS", "/run/opengl-driver/share/glvnd/egl_vendor.d");
    EXPECT_EQ(facts().unsearched, std::vector<std::string>{"/usr/share/glvnd/egl_vendor.d/10_nvidia.json"});
    EXPECT_EQ(facts().vendorVariable, "__EGL_VENDOR_LIBRARY_DIRS");
}

TEST_F(ProbeFacts, NameMissingLibraryOfVendor) {
    set("__EGL_VENDOR_LIBRARY_DIRS", (root_ / "a").string() + ":" + (root_ / "b").string());
    file("b/10_nvidia.json", vendorText(SPHERULE_VENDOR_WITHOUT_PART));
    file("a/50_gone.json", vendorText("libEGL_gone.so.0"));
    file("a/60_wrong.json", "{}");
    const auto vendors = eglVendors();
    ASSERT_EQ(vendors.size(), 3U) << "of both folders, in their order";
    EXPECT_EQ(vendors[0].library, "libEGL_gone.so.0");
    EXPECT_TRUE(vendors[0].problem.starts_with("libEGL_gone.so.0: cannot open shared object file"))
        << vendors[0].problem;
    EXPECT_NE(vendors[1].problem.find("is no vendor file"), std::string::npos) << vendors[1].problem;
    EXPECT_TRUE(vendors[2].problem.starts_with("libspherule_vendor_part.so: cannot open")) << vendors[2].problem;

    Probe seen;
    seen.vendors = {vendors[2]};
    HostFacts host;
    host.nvidiaDriver = true;
    EXPECT_NE(nvidiaHint(seen, host).find("because libspherule_vendor_part.so, which it needs, is missing"),
              std::string::npos)
        << nvidiaHint(seen, host);
}

}  // namespace
}  // namespace spherule::compute::detail
