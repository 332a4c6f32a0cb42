#include "scene_support.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "scene/json.h"

namespace spherule::scene::testing {

v1::Scene parsed(const std::string& json) {
    auto message = parseJson(json, "test.json");
    EXPECT_TRUE(message) << message.error().text() << "\n" << json;
    return message ? *message : v1::Scene();
}

Result<Scene> builtWith(std::string_view members, const Overrides& overrides) {
    std::string json = R"("bounds": {"min": [0, 0, 0], "max": [1, 1, 1]})";
    if (!members.empty()) json.append(", ").append(members);
    return build(parsed(object(json)), overrides);
}

Scene sceneWith(std::string_view members, const Overrides& overrides) {
    auto scene = builtWith(members, overrides);
    EXPECT_TRUE(scene) << scene.error().text();
    return scene ? *scene : Scene();
}

std::string refusalOf(std::string_view members, const Overrides& overrides) {
    const auto scene = builtWith(members, overrides);
    return scene ? "accepted" : scene.error().text();
}

std::string object(std::string_view members) {
    return std::string("{").append(members).append("}");
}

std::string group(std::string_view members) {
    return std::string(R"("groups": [{)").append(members).append("}]");
}

Folder::Folder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("spherule-scene-" + std::to_string(getpid()) + "-" + std::to_string(++count));
    std::filesystem::create_directories(path_);
}

Folder::~Folder() {
    std::filesystem::remove_all(path_);
}

std::string Folder::write(std::string_view name, std::string_view text) const {
    const std::filesystem::path path = path_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

}  // namespace spherule::scene::testing
