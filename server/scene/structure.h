#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scene/cuts.h"
#include "scene/text_places.h"

namespace spherule::scene {

// A place of a scene's JSON text that does not follow the rules of scene.proto.
struct Mistake {
    std::size_t offset = 0;  // bytes from the beginning of the text
    std::string path;        // of the field; empty: the whole text
    std::string message;
    std::string meant;  // path of the field that is misspelt or missing; empty: `path`
};

constexpr std::size_t mostMistakes = 1000;

struct Structure {
    std::vector<Mistake> mistakes;  // in the order of their places
    std::vector<Cut> cuts;          // the text without these parts has no mistakes, but may lack values
    bool wholeRead = true;          // false: the search ended before the end of the text
};

// Finds the structural mistakes of a scene's JSON text: wrong JSON, unknown, missing and duplicate fields, wrong types,
// numbers out of range. Names may be written as in JSON or as in scene.proto. The search ends at the first syntax
// error, and after mostMistakes. Any thread.
Structure structureOf(std::string_view text);

// Finds the offsets of the values at paths such as "groups[0].list". Any thread.
void find(TextPlaces& places, std::string_view text);

}  // namespace spherule::scene
