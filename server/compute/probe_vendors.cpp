#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <nlohmann/json.hpp>

#include "compute/probe.h"

namespace spherule::compute::detail {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> splitPaths(const char* text) {
    std::vector<fs::path> paths;
    std::istringstream in(text);
    for (std::string path; std::getline(in, path, ':');) paths.emplace_back(path);
    return paths;
}

// Returns the vendor files in the order of glvnd's own search (see src/EGL/icd_enumeration.md of libglvnd).
std::vector<fs::path> vendorFiles() {
    if (const char* const files = std::getenv("__EGL_VENDOR_LIBRARY_FILENAMES")) return splitPaths(files);
    std::vector<fs::path> folders{"/etc/glvnd/egl_vendor.d", "/usr/share/glvnd/egl_vendor.d"};
    if (const char* const named = std::getenv("__EGL_VENDOR_LIBRARY_DIRS")) folders = splitPaths(named);
    std::vector<fs::path> files;
    for (const auto& folder : folders) {
        std::error_code none;
        std::vector<fs::path> here;
        for (const auto& entry : fs::directory_iterator(folder, none)) {
            if (entry.path().extension() == ".json") here.push_back(entry.path());
        }
        std::sort(here.begin(), here.end());
        files.insert(files.end(), here.begin(), here.end());
    }
    return files;
}

ProbeVendor describe(const fs::path& file) {
    ProbeVendor vendor;
    vendor.file = file.string();
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto parsed = nlohmann::json::parse(text, nullptr, false);
    const nlohmann::json::json_pointer path("/ICD/library_path");
    if (parsed.is_discarded() || !parsed.contains(path) || !parsed.at(path).is_string()) {
        vendor.problem = "cannot be read, or is no vendor file: it has no ICD.library_path";
        return vendor;
    }
    vendor.library = parsed.at(path).get<std::string>();
    if (void* const library = dlopen(vendor.library.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
        dlclose(library);
    } else {
        vendor.problem = dlerror();
    }
    return vendor;
}

}  // namespace

std::vector<ProbeVendor> eglVendors() {
    std::vector<ProbeVendor> vendors;
    for (const auto& file : vendorFiles()) vendors.push_back(describe(file));
    return vendors;
}

}  // namespace spherule::compute::detail
