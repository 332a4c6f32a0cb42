#pragma once

#include <optional>
#include <string_view>

namespace spherule::scene {

// The scene that is run by default. It stands for a scene that depends on the device.
constexpr std::string_view defaultScene = "box";

// Returns the JSON text of a scene that is part of the program; nullopt if there is none of that name.
std::optional<std::string_view> embeddedScene(std::string_view name, std::string_view deviceKind);

}  // namespace spherule::scene
