#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::scene {

// The scene that is run by default. It stands for a scene that depends on the device.
constexpr std::string_view defaultScene = "rapids";

// Returns the JSON text of a scene that is part of the program; nullopt if there is none of that name.
std::optional<std::string_view> embeddedScene(std::string_view name, std::string_view deviceKind);

struct CatalogEntry {
    std::string name;
    std::string description;
    std::string whatToTry;
    std::uint32_t spheres;  // at the beginning
};

// Returns the scenes that are part of the program, each once: the default one of the device, then by their number of
// spheres.
std::vector<CatalogEntry> catalog(std::string_view deviceKind);

}  // namespace spherule::scene
