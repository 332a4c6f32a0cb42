#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace spherule {

// Returns the name that is most like a misspelt word, without regard to case, '_' and '-'. The word is at most two
// characters away from it, or a third of its length: to insert, to remove, to replace, or to swap with the next one. If
// no name is so near, it is one that begins like the word. nullopt if there is none. Any thread.
std::optional<std::string> suggestionFor(std::string_view word, std::span<const std::string> names);

// Returns `; did you mean "name"?` with that name; empty if there is none.
std::string didYouMean(std::string_view word, std::span<const std::string> names);

}  // namespace spherule
