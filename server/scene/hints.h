#pragma once

#include <span>
#include <string>
#include <string_view>

#include <google/protobuf/descriptor.h>

namespace spherule::scene {

// Returns `; did you mean "name"?` with the name that is most like the word; empty if none is.
std::string didYouMean(std::string_view word, std::span<const std::string> names);

// Returns "; Material has one of this name" if one or two other messages of a scene have a field of this name.
std::string otherOwnersOf(std::string_view field, const google::protobuf::Descriptor& message);

}  // namespace spherule::scene
