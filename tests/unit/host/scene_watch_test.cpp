#include "host/scene_watch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "core/heartbeat.h"
#include "temporary_folder.h"

namespace spherule::host {
namespace {

using namespace std::chrono_literals;
constexpr auto period = 10ms;

constexpr const char* scene = R"({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}})";

// Waits until a change is reported; false if there is none for ten seconds.
bool changes(SceneWatch& watch) {
    for (int k = 0; k < 1000; ++k) {
        if (const auto change = watch.takeChange()) return true;
        std::this_thread::sleep_for(10ms);
    }
    return false;
}

// Waits until a change is reported. Returns the names of the files, with "-" before those that are gone.
std::vector<std::string> changed(SceneWatch& watch) {
    std::vector<std::string> names;
    for (int k = 0; k < 1000 && names.empty(); ++k) {
        std::this_thread::sleep_for(10ms);
        const auto change = watch.takeChange();
        if (!change) continue;
        for (const std::string& file : change->saved) names.push_back(std::filesystem::path(file).filename());
        for (const std::string& file : change->gone)
            names.push_back(std::string("-").append(std::filesystem::path(file).filename()));
    }
    return names;
}

std::string sceneWith(const std::string& csv) {
    return R"({"bounds": {"min": [0, 0, 0], "max": [1, 1, 1]}, "groups": [{"csv": {"file": ")" + csv + R"("}}]})";
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

TEST(SceneWatch, TellsWhichFileHasChangedAndWhetherItIsGone) {
    using Names = std::vector<std::string>;
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", sceneWith("a.csv"));
    folder.write("a.csv", "x,y,z\n");
    SceneWatch watch(path, period);
    folder.write("a.csv", "x,y,z,radius\n");
    EXPECT_EQ(changed(watch), Names({"a.csv"}));
    std::filesystem::remove(folder / "a.csv");
    EXPECT_EQ(changed(watch), Names({"-a.csv"}));
    folder.write("scene.json", sceneWith("b.csv"));
    EXPECT_EQ(changed(watch), Names({"scene.json"}));
    std::filesystem::remove(path);
    EXPECT_EQ(changed(watch), Names({"-scene.json"}));
    // Only the last state of a file counts.
    folder.write("scene.json", sceneWith("b.csv"));
    EXPECT_TRUE(changes(watch));
    std::filesystem::remove(path);
    std::this_thread::sleep_for(20 * period);
    folder.write("scene.json", sceneWith("b.csv"));
    std::this_thread::sleep_for(20 * period);
    EXPECT_EQ(changed(watch), Names({"scene.json"}));
}

TEST(SceneWatch, ForgetsFilesThatTheSceneNamesNoMore) {
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", sceneWith("a.csv"));
    SceneWatch watch(path, period);
    folder.write("scene.json", scene);
    EXPECT_TRUE(changes(watch));
    folder.write("a.csv", "x,y,z\n");
    EXPECT_TRUE(rests(watch));
}

TEST(SceneWatch, SaysWhatBecomesOfTheScene) {
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", scene);
    const std::string csv = folder / "a.csv";
    const SceneWatch watch(path, period);
    EXPECT_EQ(watch.savedToLoad({.saved = {csv, path}, .gone = {}}), path);
    EXPECT_EQ(watch.savedToLoad({.saved = {csv}, .gone = {}}), csv);
    EXPECT_EQ(watch.savedToLoad({.saved = {csv}, .gone = {path}}), std::nullopt);
    EXPECT_EQ(watch.savedToLoad({.saved = {}, .gone = {csv}}), std::nullopt);
    EXPECT_EQ(watch.goneText(path), "scene.json is gone. The world goes on as it is. Save the file again to load it.");
    EXPECT_EQ(watch.goneText(csv),
              "a.csv, which scene.json names, is gone. The world goes on as it is. Save the file again to load it.");
    const Error mistake{ErrorKind::Input, "a.csv:1", "is wrong"};
    EXPECT_EQ(watch.failureText(csv, mistake),
              "a.csv was saved but scene.json is not loaded, the world stays as it is. a.csv:1: is wrong");
    EXPECT_EQ(watch.failureText(path, {ErrorKind::Refused, "", "session 2 has asked for reset", Cause::Ended}),
              "scene.json was saved but is not loaded: session 2 has asked for reset. Save it again to load it.");
}

TEST(SceneWatch, GoesOnAfterAnException) {
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", scene);
    std::atomic<int> calls = 0;
    SceneWatch watch(path, period, [&calls](const std::string& file) {
        if (++calls == 2) throw std::bad_alloc();
        return scene::filesNamedIn(file);
    });
    folder.write("scene.json", std::string(scene) + "\n");
    EXPECT_TRUE(changes(watch));
    EXPECT_GE(calls, 3);
}

// A read that hangs in the thread of the watch must not keep the watchdog from its work.
TEST(SceneWatch, DoesNotPauseTheWatchdog) {
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", scene);
    std::atomic<bool> paused = false;
    std::atomic<bool> read = false;
    SceneWatch watch(path, period, [&](const std::string& file) {
        const std::jthread look([&paused](const std::stop_token& stop) {
            while (!stop.stop_requested()) paused = paused || !heartbeat::status().expected;
        });
        std::this_thread::sleep_for(20ms);
        auto named = scene::filesNamedIn(file);
        read = true;
        return named;
    });
    EXPECT_TRUE(paused.exchange(false)) << "the thread that makes the watch is not the watch's";
    read = false;
    folder.write("scene.json", std::string(scene) + std::string(std::size_t{24} << 20U, ' '));
    EXPECT_TRUE(changes(watch));
    EXPECT_TRUE(read);
    EXPECT_FALSE(paused);
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
