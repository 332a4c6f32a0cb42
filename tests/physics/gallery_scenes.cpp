#include "gallery_scenes.h"

#include <algorithm>
#include <vector>

#include "scene/catalog.h"

namespace spherule::physics {

std::vector<std::string> galleryScenes() {
    std::vector<std::string> names;
    for (const scene::CatalogEntry& entry : scene::catalog("cpu")) names.push_back(entry.name);
    return names;
}

std::string testNameOf(const testing::TestParamInfo<std::string>& parameter) {
    std::string name = parameter.param;
    std::ranges::replace(name, '-', '_');
    return name;
}

scene::Scene reduced(scene::Scene scene, std::uint32_t most) {
    const auto free = static_cast<std::uint64_t>(
        std::ranges::count_if(scene.spheres, [](const scene::Sphere& sphere) { return !sphere.fixed; }));
    if (free <= most) return scene;
    std::vector<std::uint64_t> seen(scene.groups.size());
    std::vector<std::uint32_t> surplus;
    for (std::uint32_t k = 0; k < scene.spheres.size(); ++k) {
        const scene::Sphere& sphere = scene.spheres[k];
        if (!sphere.fixed && seen[sphere.group]++ >= scene.groups[sphere.group].count * std::uint64_t{most} / free)
            surplus.push_back(k);
    }
    scene::removeSpheres(scene, surplus);
    return scene;
}

}  // namespace spherule::physics
