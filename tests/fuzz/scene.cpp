// Fuzzes the loader of scene files. Bounds the number of spheres, so that no input needs minutes for filling.
#include <cstddef>
#include <cstdint>
#include <string>

#include "scene/json.h"
#include "scene/load.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule;
    constexpr std::uint32_t mostSpheres = 1000;
    auto message = scene::parseJson(std::string(reinterpret_cast<const char*>(data), size), "fuzz.json");
    if (!message) return 0;
    for (v1::Group& group : *message->mutable_groups()) {
        if (group.has_fill() && group.fill().count() > mostSpheres) group.mutable_fill()->set_count(mostSpheres);
        if (group.has_lattice() && (!group.lattice().has_count() || group.lattice().count() > mostSpheres))
            group.mutable_lattice()->set_count(mostSpheres);
    }
    (void)scene::build(*message);
    return 0;
}
