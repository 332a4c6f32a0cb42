// Collects the facts of this host on which it depends whether OpenGL finds a GPU.
#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "compute/probe.h"

namespace spherule::compute::detail {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

// Returns the files of a folder whose names contain `wanted`, sorted.
std::vector<fs::path> filesIn(const fs::path& folder, const char* wanted) {
    std::error_code none;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder, none))
        if (entry.path().filename().string().find(wanted) != std::string::npos) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string below(const fs::path& root, const fs::path& path) {
    return (fs::path("/") / path.lexically_relative(root)).string();
}

std::vector<std::string> closedIn(const fs::path& root, const char* folder, const char* wanted) {
    std::vector<std::string> closed;
    for (const auto& file : filesIn(root / folder, wanted)) {
        std::error_code none;
        if (!fs::is_directory(file, none) && access(file.c_str(), R_OK | W_OK) != 0)
            closed.push_back(below(root, file));
    }
    return closed;
}

HostFacts::Place placeOf(const fs::path& root) {
    std::error_code none;
    if (!variable("KUBERNETES_SERVICE_HOST").empty()) return HostFacts::Place::Pod;
    const bool container = fs::exists(root / ".dockerenv", none) || fs::exists(root / "run/.containerenv", none);
    return container ? HostFacts::Place::Container : HostFacts::Place::Host;
}

bool opens(const char* library) {
    void* const handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
    if (handle != nullptr) dlclose(handle);
    return handle != nullptr;
}

// The variable names the slice to a container. The access rights of slices are below proc/driver/nvidia/capabilities.
bool hasMigSlice(const fs::path& root) {
    if (variable("NVIDIA_VISIBLE_DEVICES").starts_with("MIG-")) return true;
    for (const auto& gpu : filesIn(root / "proc/driver/nvidia/capabilities", "gpu"))
        if (!filesIn(gpu / "mig", "gi").empty()) return true;
    return false;
}

// Returns NVIDIA's vendor files in the folders of distributions and container runtimes that glvnd does not search.
// glvnd searches the first two, unless a variable replaces its search. NixOS and Talos use the others.
std::vector<std::string> unsearchedIn(const fs::path& root, bool replaced) {
    constexpr std::array folders{"etc/glvnd/egl_vendor.d", "usr/share/glvnd/egl_vendor.d",
                                 "run/opengl-driver/share/glvnd/egl_vendor.d", "usr/local/share/glvnd/egl_vendor.d"};
    const std::string searched = variable("__EGL_VENDOR_LIBRARY_DIRS") + variable("__EGL_VENDOR_LIBRARY_FILENAMES");
    std::vector<std::string> files;
    for (std::size_t k = replaced ? 0 : 2; k < folders.size(); ++k) {
        if (searched.find(std::string("/") + folders.at(k)) != std::string::npos) continue;
        for (const auto& file : filesIn(root / folders.at(k), "nvidia")) files.push_back(below(root, file));
    }
    return files;
}

}  // namespace

HostFacts hostFacts(const fs::path& root) {
    HostFacts facts;
    std::error_code none;
    facts.place = placeOf(root);
    facts.nvidiaDriver =
        fs::exists(root / "proc/driver/nvidia/version", none) || fs::exists(root / "dev/nvidiactl", none);
    facts.nvidiaLibrary = opens("libEGL_nvidia.so.0");
    facts.migSlice = hasMigSlice(root);
    facts.nvidiaCapabilities = variable("NVIDIA_DRIVER_CAPABILITIES");
    // If both are set, glvnd uses the second.
    for (const char* const name : {"__EGL_VENDOR_LIBRARY_DIRS", "__EGL_VENDOR_LIBRARY_FILENAMES"})
        if (std::getenv(name) != nullptr) facts.vendorVariable = name;
    facts.unsearched = unsearchedIn(root, !facts.vendorVariable.empty());
    facts.closedDrmFiles = closedIn(root, "dev/dri", "renderD");
    facts.closedNvidiaFiles = closedIn(root, "dev", "nvidia");
    return facts;
}

}  // namespace spherule::compute::detail
