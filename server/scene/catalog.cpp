#include "scene/catalog.h"

#include <algorithm>

#include "embedded/exampleScenes.h"
#include "scene/load.h"

namespace spherule::scene {

namespace {

constexpr std::string_view suffix = ".json";

// Returns the scene with as many spheres as the kind of device simulates in about real time.
std::string_view boxFor(std::string_view deviceKind) {
    if (deviceKind == "gpu") return "box-50k";
    if (deviceKind == "cpu") return "box-10k";
    return "box-4k";
}

std::string_view nameOf(const embedded::File& file) {
    return file.path.substr(0, file.path.size() - suffix.size());
}

}  // namespace

std::optional<std::string_view> embeddedScene(std::string_view name, std::string_view deviceKind) {
    if (name == defaultScene) name = boxFor(deviceKind);
    const auto files = embedded::exampleScenes();
    const auto found = std::find_if(files.begin(), files.end(), [&](const auto& file) { return nameOf(file) == name; });
    if (found == files.end()) return std::nullopt;
    return found->bytes;
}

std::vector<std::string> names() {
    std::vector<std::string> result{std::string(defaultScene)};
    for (const embedded::File& file : embedded::exampleScenes()) result.emplace_back(nameOf(file));
    std::sort(result.begin(), result.end());
    return result;
}

}  // namespace spherule::scene
