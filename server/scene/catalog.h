#pragma once

#include <optional>
#include <string_view>

namespace spherule::scene {

// The scene that is run when none is named; which one it stands for depends on the device.
constexpr std::string_view defaultScene = "box";

// The JSON text of a scene that comes with the program.
std::optional<std::string_view> embeddedScene(std::string_view name, std::string_view deviceKind);

}  // namespace spherule::scene
