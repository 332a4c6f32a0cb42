#include "scene_support.h"

#include <gtest/gtest.h>

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

}  // namespace spherule::scene::testing
