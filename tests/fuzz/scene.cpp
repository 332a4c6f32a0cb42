// Fuzzes the loader of scene files. Bounds the number of spheres, so that no input needs minutes for filling.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>

#include "scene/build.h"
#include "scene/json.h"
#include "scene/load.h"
#include "scene/structure.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule;
    constexpr std::uint32_t mostSpheres = 1000;
    const std::string text(reinterpret_cast<const char*>(data), size);
    const scene::Structure structure = scene::structureOf(text);
    const bool structured = structure.mistakes.empty();
    // The rest of a text whose mistakes are cut has none but missing fields.
    if (structure.wholeRead && scene::structureOf(scene::withoutCuts(text, structure.cuts)).cuts.size() > 0)
        std::abort();
    auto message = scene::parseJson(text, "fuzz.json");
    if (!message) return 0;
    for (v1::Group& group : *message->mutable_groups()) {
        if (group.has_fill() && (group.fill().has_fraction() || group.fill().count() > mostSpheres))
            group.mutable_fill()->set_count(mostSpheres);
        if (group.has_lattice() && (!group.lattice().has_count() || group.lattice().count() > mostSpheres))
            group.mutable_lattice()->set_count(mostSpheres);
    }
    const auto built = scene::build(*message);
    // The check for all mistakes finds one if the scene is refused, and only then.
    if (built.has_value() != scene::errorsIn(std::nullopt, *message, {}).empty()) std::abort();
    scene::TextPlaces places;
    if (structured && !built) places.add(built.error().where);
    scene::find(places, text);
    return 0;
}
