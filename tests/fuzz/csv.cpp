// Fuzzes the reader of CSV files with spheres. Bit 0 of the first byte: the scene gives a radius.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "scene/build.h"

namespace {

spherule::v1::Scene sceneOf(const std::string& file, bool radius) {
    spherule::v1::Scene scene;
    for (const double low : {-1.0, -1.0, -1.0}) scene.mutable_bounds()->add_min(low);
    for (const double high : {1.0, 1.0, 1.0}) scene.mutable_bounds()->add_max(high);
    spherule::v1::Group& group = *scene.add_groups();
    group.mutable_csv()->set_file(file);
    if (radius) group.mutable_radius()->set_constant(0.01);
    return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule;
    if (size == 0) return 0;
    static const int file = memfd_create("spheres.csv", MFD_CLOEXEC);
    const auto length = static_cast<ssize_t>(size - 1);
    if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data + 1, size - 1, 0) != length) std::abort();
    (void)scene::buildIn("/proc/self/fd", sceneOf(std::to_string(file), (data[0] & 1U) != 0), {});
    return 0;
}
