#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace spherule {

// Returns the name that is most like a misspelt word: at most two characters are to insert, remove or replace. nullopt
// if no name is so near. Any thread.
std::optional<std::string> suggestionFor(std::string_view word, std::span<const std::string> names);

}  // namespace spherule
