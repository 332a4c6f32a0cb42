#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "scene/build.h"

namespace spherule::fuzz {

// Builds a scene of 2 m whose group reads the file with these bytes after the first. Bit 0 of the first byte: the group
// gives a radius. `source`: makes a source of the group that names the file; it receives the first byte, too.
template <class Source>
void buildFromFile(const std::uint8_t* data, std::size_t size, Source source) {
    if (size == 0) return;
    static const int file = memfd_create("spheres", MFD_CLOEXEC);
    const auto length = static_cast<ssize_t>(size - 1);
    if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data + 1, size - 1, 0) != length) std::abort();
    v1::Scene scene;
    for (const double low : {-1.0, -1.0, -1.0}) scene.mutable_bounds()->add_min(low);
    for (const double high : {1.0, 1.0, 1.0}) scene.mutable_bounds()->add_max(high);
    v1::Group& group = *scene.add_groups();
    source(group, std::to_string(file), data[0]);
    if ((data[0] & 1U) != 0) group.mutable_radius()->set_constant(0.01);
    (void)scene::buildIn("/proc/self/fd", scene, {});
}

}  // namespace spherule::fuzz
