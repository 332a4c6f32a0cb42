#include "scene/catalog.h"

#include <algorithm>

#include "embedded/exampleScenes.h"
#include "scene/json.h"
#include "scene/load.h"

namespace spherule::scene {

namespace {

constexpr std::string_view suffix = ".json";

// A name that stands for one of three scenes: the one whose number of spheres suits the kind of device.
struct SizedScene {
    std::string_view name;
    std::string_view gpu;
    std::string_view cpu;
    std::string_view software;
};

constexpr SizedScene sizedScenes[] = {{defaultScene, "rapids-50k", "rapids-6k", "rapids-3k"},
                                      {"box", "box-50k", "box-10k", "box-4k"}};

std::string_view sceneFor(std::string_view name, std::string_view deviceKind) {
    for (const SizedScene& sized : sizedScenes) {
        if (sized.name != name) continue;
        if (deviceKind == "gpu") return sized.gpu;
        return deviceKind == "cpu" ? sized.cpu : sized.software;
    }
    return name;
}

std::string_view nameOf(const embedded::File& file) {
    return file.path.substr(0, file.path.size() - suffix.size());
}

// The spheres of a scene that gives the number of each group. Every scene of the program does.
std::uint32_t spheresIn(const v1::Scene& scene) {
    std::uint32_t count = 0;
    for (const v1::Group& group : scene.groups())
        count +=
            static_cast<std::uint32_t>(group.list().spheres_size()) + group.lattice().count() + group.fill().count();
    return count;
}

std::vector<CatalogEntry> readCatalog() {
    std::vector<CatalogEntry> entries;
    for (const embedded::File& file : embedded::exampleScenes()) {
        const auto scene = parseJson(std::string(file.bytes), file.path);
        if (!scene) continue;  // a test loads every scene
        entries.push_back({scene->name(), scene->description(), scene->what_to_try(), spheresIn(*scene)});
    }
    std::ranges::stable_sort(entries, {}, &CatalogEntry::spheres);
    return entries;
}

}  // namespace

std::optional<std::string_view> embeddedScene(std::string_view name, std::string_view deviceKind) {
    name = sceneFor(name, deviceKind);
    const auto files = embedded::exampleScenes();
    const auto found = std::find_if(files.begin(), files.end(), [&](const auto& file) { return nameOf(file) == name; });
    if (found == files.end()) return std::nullopt;
    return found->bytes;
}

std::vector<CatalogEntry> catalog(std::string_view deviceKind) {
    static const std::vector<CatalogEntry> read = readCatalog();
    std::vector<CatalogEntry> entries = read;
    const auto isFirst = [first = sceneFor(defaultScene, deviceKind)](const CatalogEntry& entry) {
        return entry.name == first;
    };
    std::stable_partition(entries.begin(), entries.end(), isFirst);
    return entries;
}

std::vector<std::string> names() {
    std::vector<std::string> result;
    for (const SizedScene& sized : sizedScenes) result.emplace_back(sized.name);
    for (const embedded::File& file : embedded::exampleScenes()) result.emplace_back(nameOf(file));
    std::sort(result.begin(), result.end());
    return result;
}

}  // namespace spherule::scene
