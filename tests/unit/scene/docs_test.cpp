#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

// Returns the first code block of `language` in the page on the scene format.
std::string blockOf(const std::string& language) {
    std::ifstream file(SPHERULE_DOCS "/scene-format.md");
    const std::string page(std::istreambuf_iterator<char>(file), {});
    const std::string fence = "```";
    const std::size_t start = page.find(fence + language + "\n");
    if (start == std::string::npos) return "";
    const std::size_t text = page.find('\n', start) + 1;
    return page.substr(text, page.find(fence, text) - text);
}

TEST(SceneDocs, CompleteExampleLoads) {
    const TemporaryFolder folder;
    (void)folder.write("everything.csv", blockOf("csv"));
    const auto scene = load(folder.write("everything.json", blockOf("json")), "software");
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->spheres.size(), 2U + 1000U + 500U + 2U);
    EXPECT_EQ(scene->obstacles.size(), 4U);
    EXPECT_EQ(scene->materials.size(), 3U);
    EXPECT_EQ(scene->pairs.size(), 1U);
    EXPECT_EQ(scene->spheres[0].spin, glm::vec3(0, -40, 0));
}

}  // namespace
}  // namespace spherule::scene::testing
