#include "host/scene_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "temporary_folder.h"

namespace spherule::host {
namespace {

using namespace std::chrono_literals;
constexpr auto period = 10ms;

constexpr const char* scene = R"({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}})";

// Waits until a change is reported; false if there is none for ten seconds.
bool changes(SceneWatch& watch) {
    for (int k = 0; k < 1000; ++k) {
        if (watch.takeChange()) return true;
        std::this_thread::sleep_for(10ms);
    }
    return false;
}

bool rests(SceneWatch& watch) {
    std::this_thread::sleep_for(20 * period);
    return !watch.takeChange();
}

TEST(SceneWatch, ReportsEachChangeOnce) {
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", scene);
    SceneWatch watch(path, period);
    EXPECT_EQ(watch.name(), "scene.json");
    EXPECT_TRUE(rests(watch));
    folder.write("scene.json", std::string(scene) + "\n");
    EXPECT_TRUE(changes(watch));
    EXPECT_TRUE(rests(watch));
    // Another file in its place, with the same size.
    std::filesystem::rename(folder.write("other.json", std::string(scene) + " "), path);
    EXPECT_TRUE(changes(watch));
    std::filesystem::remove(path);
    EXPECT_TRUE(changes(watch));
    folder.write("scene.json", scene);
    EXPECT_TRUE(changes(watch));
    EXPECT_TRUE(rests(watch));
}

TEST(SceneWatch, FollowsTheFilesThatTheSceneNames) {
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", scene);
    SceneWatch watch(path, period);
    folder.write("scene.json",
                 R"({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}, "groups": [{"csv": {"file": "a.csv"}}],
                                   "obstacles": [{"mesh": {"file": "b.stl"}}]})");
    EXPECT_TRUE(changes(watch));
    EXPECT_TRUE(rests(watch));
    folder.write("a.csv", "x,y,z\n");
    EXPECT_TRUE(changes(watch));
    folder.write("b.stl", "solid");
    EXPECT_TRUE(changes(watch));
    // Also while the scene has a mistake.
    folder.write("scene.json", "{");
    EXPECT_TRUE(changes(watch));
    folder.write("a.csv", "x,y,z,radius\n");
    EXPECT_TRUE(changes(watch));
    folder.write("unrelated.csv", "");
    EXPECT_TRUE(rests(watch));
}

TEST(SceneWatch, LoadsTheFileOrListsItsMistakes) {
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", scene);
    const SceneWatch watch(path, period);
    const MakeScene load = watch.load("cpu", {});
    Progress progress;
    ASSERT_TRUE(load(progress));
    EXPECT_EQ(load(progress)->name, "scene");
    folder.write("scene.json", "{\n\"stepp\": 1,\n\"gravity\": [0]}");
    const std::string text = load(progress).error().text();
    EXPECT_EQ(text.find("It has 3 mistakes:\n" + path + ":1:"), 0U) << text;
    EXPECT_NE(text.find("\n" + path + ":2:1: stepp"), std::string::npos) << text;
    EXPECT_NE(text.find("\n" + path + ":3:"), std::string::npos) << text;
    folder.write("scene.json", "{\n\"bounds\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]}, \"step\": 9}");
    EXPECT_EQ(load(progress).error().text().find(path + ":2:"), 0U);
}

}  // namespace
}  // namespace spherule::host
