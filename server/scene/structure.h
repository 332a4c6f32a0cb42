#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::scene {

// A place of a scene's JSON text that does not follow the rules of scene.proto.
struct Mistake {
    std::size_t offset = 0;  // bytes from the beginning of the text
    std::string path;        // of the field; empty: the whole text
    std::string message;
};

constexpr std::size_t mostMistakes = 1000;

// Returns the structural mistakes of a scene's JSON text, in the order of their places: wrong JSON, unknown, missing
// and duplicate fields, wrong types, numbers out of range. Names may be written as in JSON or as in scene.proto. The
// search ends at the first syntax error, and after mostMistakes. Any thread.
std::vector<Mistake> structuralMistakes(std::string_view text);

// Returns the offset of the value at the path, such as "groups[0].list", in a text without structural mistakes. If
// there is no such value, it is the offset of the nearest value that would contain it. Any thread.
std::size_t offsetOf(std::string_view text, std::string_view path);

}  // namespace spherule::scene
