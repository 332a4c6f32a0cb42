#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::scene {

// A part of a JSON text: a member of an object with its name, or an entry of a list. Bytes from the beginning.
struct Cut {
    std::size_t begin = 0;
    std::size_t end = 0;
    bool isEntry = false;  // an empty object takes its place, so that other entries keep their numbers
};

// Returns the JSON text without these parts. One may contain others. Any thread.
std::string withoutCuts(std::string_view text, std::vector<Cut> cuts);

}  // namespace spherule::scene
