#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "scene/catalog.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

std::string refusalOfFile(const TemporaryFolder& folder, const std::string& json) {
    const auto scene = load(folder.write("falling.json", json), "software");
    if (scene) return "accepted";
    const std::string text = scene.error().text();
    return text.substr(text.find("falling.json"));
}

// A scene in the unit cube with these members, which begin in the second line.
std::string cube(const std::string& members) {
    return "{\"bounds\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]},\n" + members + "}";
}

TEST(SceneLoad, EveryNamedSceneLoads) {
    for (const std::string& name : names()) {
        const auto scene = load(name, "software");
        ASSERT_TRUE(scene) << scene.error().text();
        EXPECT_EQ(scene->name, name == "box" ? "box-4k" : name == "rapids" ? "rapids-3k" : name);
        EXPECT_FALSE(scene->description.empty()) << name;
        EXPECT_FALSE(scene->whatToTry.empty()) << name;
        EXPECT_TRUE(mayHaveAny(*scene)) << name;
        for (const Group& group : scene->groups) EXPECT_FALSE(group.look.colour.empty()) << name;
    }
}

TEST(SceneLoad, NamesAreSortedAndIncludeTheExamples) {
    const std::vector<std::string> expected{
        "avalanche",  "ball-mill",  "billiards", "bounce",     "bowl-1m",         "box",   "box-10k",  "box-4k",
        "box-50k",    "brazil-nut", "conveyor",  "cradle",     "cradle-touching", "drum",  "fountain", "galton",
        "gas",        "hopper",     "hourglass", "landslide",  "marble-run",      "mixer", "piston",   "pour",
        "press",      "rapids",     "rapids-3k", "rapids-50k", "rapids-6k",       "screw", "sieve",    "silo",
        "snow-globe", "sorter",     "stress-1m", "tornado",    "two-spheres"};
    EXPECT_EQ(names(), expected);
}

TEST(SceneLoad, SizedScenesDependOnTheDevice) {
    EXPECT_EQ(load("box", "gpu")->spheres.size(), 50'000U);
    EXPECT_EQ(load("box", "cpu")->spheres.size(), 10'000U);
    EXPECT_EQ(load("box", "software")->spheres.size(), 4'000U);
    for (const auto& [kind, name] : {std::pair{"gpu", "rapids-50k"}, {"cpu", "rapids-6k"}, {"software", "rapids-3k"}})
        EXPECT_EQ(load(std::string(defaultScene), kind)->name, name);
}

TEST(SceneCatalog, DescribesEachSceneWithoutBuildingIt) {
    std::vector<std::string> listed;
    for (const CatalogEntry& entry : catalog("cpu")) {
        const auto scene = load(entry.name, "cpu");
        ASSERT_TRUE(scene) << scene.error().text();
        EXPECT_EQ(entry.spheres, scene->spheres.size()) << entry.name;
        EXPECT_EQ(entry.description, scene->description) << entry.name;
        listed.push_back(entry.name);
    }
    std::vector<std::string> expected = names();
    std::erase(expected, "box");
    std::erase(expected, "rapids");
    std::ranges::sort(listed);
    EXPECT_EQ(listed, expected) << "each once, and none that stands for another one";
}

TEST(SceneCatalog, BeginsWithTheDefaultSceneOfTheDevice) {
    for (const auto& [kind, name] : {std::pair{"gpu", "rapids-50k"}, {"cpu", "rapids-6k"}, {"software", "rapids-3k"}}) {
        const auto entries = catalog(kind);
        EXPECT_EQ(entries.front().name, name);
        EXPECT_TRUE(std::ranges::is_sorted(entries.begin() + 1, entries.end(), {}, &CatalogEntry::spheres));
    }
}

TEST(SceneLoad, OneMillionSpheresLoadWithinSeconds) {
    const auto start = std::chrono::steady_clock::now();
    const auto scene = load("stress-1m", "software");
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->spheres.size(), 1'000'000U);
    EXPECT_LT(seconds.count(), 10);
}

TEST(SceneLoad, CradlesHaveTheNamedProperties) {
    const Scene apart = *load("cradle", "cpu");
    const Scene touching = *load("cradle-touching", "cpu");
    for (std::size_t i = 1; i < 5; ++i) {
        EXPECT_NEAR(apart.spheres[i].position.x - apart.spheres[i - 1].position.x, 1.01 * 0.125, 1e-12);
        EXPECT_EQ(touching.spheres[i].position.x - touching.spheres[i - 1].position.x, 0.125);
    }
    EXPECT_EQ(apart.spheres[0].velocity, glm::vec3(1, 0, 0));
    EXPECT_EQ(apart.spheres[4].velocity, glm::vec3(0));
}

TEST(SceneLoad, UnknownNamesAreRefusedWithTheKnownOnes) {
    EXPECT_EQ(load("bux", "gpu").error().text(),
              "\"bux\": is not the name of a scene; there are avalanche, ball-mill, billiards, bounce, "
              "bowl-1m, box, box-10k, box-4k, box-50k, brazil-nut, conveyor, cradle, cradle-touching, drum, "
              "fountain, galton, gas, hopper, hourglass, landslide, marble-run, mixer, piston, pour, press, "
              "rapids, rapids-3k, rapids-50k, rapids-6k, screw, sieve, silo, snow-globe, sorter, stress-1m, "
              "tornado, two-spheres. A file is named with its ending, .json");
}

TEST(SceneLoad, MissingFilesAreRefused) {
    EXPECT_EQ(load("nowhere/x.json", "gpu").error().text(), "nowhere/x.json: there is no such file");
    EXPECT_EQ(load("./nothing", "gpu").error().text(), "./nothing: there is no such file");
}

TEST(SceneLoad, OnlyRegularFilesAreRead) {
    const TemporaryFolder folder;
    const std::string pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(load(pipe, "gpu").error().text(), pipe + ": is a pipe, must be a regular file");
    EXPECT_EQ(load("/tmp", "gpu").error().text(), "/tmp: is a folder, must be a regular file");
    EXPECT_EQ(load("/dev/zero", "gpu").error().text(), "/dev/zero: is a device, must be a regular file");
    EXPECT_EQ(load("/proc/self/mem", "gpu").error().text(), "/proc/self/mem: cannot be read: Input/output error");
}

TEST(SceneLoad, TooLargeFilesAreRefusedBeforeReading) {
    const TemporaryFolder folder;
    const std::string path = folder.write("large.json", "{}");
    std::filesystem::resize_file(path, 2ULL << 30U);  // a sparse file, which takes no space on the disk
    EXPECT_EQ(load(path, "gpu").error().text(), path + ": has 2147483648 bytes, at most 33554432 are allowed");
    std::string empty = R"({"groups": [{})";
    for (int k = 0; k < 2'000'000; ++k) empty += ",{}";
    EXPECT_EQ(
        refusalOfFile(folder, empty + "]}"),
        "falling.json: has 2000002 objects, at most 2000000 are allowed; give so many spheres as csv, xyz, lammps, "
        "lattice or fill");
}

TEST(SceneLoad, FileMayStartWithAByteOrderMark) {
    const TemporaryFolder folder;
    const std::string scene = "\xef\xbb\xbf{\"bounds\": {\"min\": [0,0,0], \"max\": [1,1,1]}";
    EXPECT_EQ(refusalOfFile(folder, scene + "}"), "accepted");
    EXPECT_EQ(refusalOfFile(folder, scene + " x}"), "falling.json:1:45: is not JSON: invalid literal");
}

TEST(SceneLoad, SceneWithoutANameHasTheFileName) {
    const TemporaryFolder folder;
    const auto scene = load(folder.write("quiet.json", R"({"bounds": {"min": [0,0,0], "max": [1,1,1]}})"), "gpu");
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->name, "quiet");
}

TEST(SceneLoad, ErrorsIncludeFileAndFieldPath) {
    const TemporaryFolder folder;
    EXPECT_EQ(
        refusalOfFile(folder, R"({"bounds": {"min": [0,0,0], "max": [1,1,1]}, "groups": [{"list": {}}, {"list": {}},
        {"lattice": {"min": [0,0,0], "max": [1,1,1], "spacing": -0.1}, "radius": {"constant": 0.1}}]})"),
        "falling.json:2:65: groups[2].lattice.spacing: is -0.1, must be above 0 m");
}

TEST(SceneLoad, UnknownFieldsAreNamed) {
    const TemporaryFolder folder;
    EXPECT_EQ(refusalOfFile(folder, cube(R"("gravitation": 1)")),
              "falling.json:2:1: gravitation: is not a field of Scene; did you mean \"gravity\"?");
    EXPECT_EQ(refusalOfFile(folder, cube(R"("viscosity": 1)")), "falling.json:2:1: viscosity: is not a field of Scene");
    EXPECT_EQ(refusalOfFile(folder, cube(R"("groups": [{"csv": {"fil": "a"}}])")),
              "falling.json:2:21: groups[0].csv.fil: is not a field of Csv; did you mean \"file\"?");
}

TEST(SceneLoad, WrongTypesAreNamed) {
    const TemporaryFolder folder;
    EXPECT_EQ(refusalOfFile(folder, cube(R"("quality": {"substeps": "8"})")),
              "falling.json:2:25: quality.substeps: is \"8\", must be a whole number, not negative");
    EXPECT_EQ(refusalOfFile(folder, cube(R"("sphereContacts": 1)")),
              "falling.json:2:19: sphereContacts: is 1, must be true or false");
    EXPECT_EQ(refusalOfFile(folder, "[1]"), "falling.json:1:1: is a list, must be an object");
    EXPECT_EQ(refusalOfFile(folder, cube(R"("quality": {"model": "FASTT"})")),
              "falling.json:2:22: quality.model: is \"FASTT\", must be one of FAST, BALANCED, ACCURATE; did you mean "
              "\"FAST\"?");
}

TEST(SceneLoad, SyntaxErrorsIncludeLineAndColumn) {
    const TemporaryFolder folder;
    EXPECT_EQ(refusalOfFile(folder, "{\n  \"gravity\": [1, 2, 3\n  \"bounds\": {}\n}"),
              "falling.json:3:3: is not JSON: unexpected string literal; expected ']'");
    EXPECT_EQ(refusalOfFile(folder, "{\n  \"gravity\": [1, NaN]}"), "falling.json:2:18: is not JSON: invalid literal");
    EXPECT_EQ(refusalOfFile(folder, "{\n"),
              "falling.json:2:1: is not JSON: unexpected end of input; expected string literal");
}

TEST(SceneLoad, FurtherMistakesAreCounted) {
    const TemporaryFolder folder;
    EXPECT_EQ(refusalOfFile(folder, cube(R"("step": 2, "gravity": [1])")),
              "falling.json:2:9: step: is 2, must be 1e-06 to 1 s (1 more: see `spherule scene check`)");
}

TEST(SceneLoad, ErrorsOfTheReaderHaveTheirPlace) {
    const TemporaryFolder folder;
    EXPECT_EQ(
        refusalOfFile(folder, cube("\"groups\": [{\"list\": {},\n\"material\": \"steel\"}]")),
        "falling.json:3:13: groups[0].material: is \"steel\", which is no material of the scene; it has none with a "
        "name");
}

TEST(SceneLoad, ErrorsOfTheParserHaveTheirPlace) {
    const TemporaryFolder folder;
    EXPECT_EQ(refusalOfFile(folder, cube(R"("obstacles": [{"mesh": {"data": "abcde"}}])")),
              "falling.json:2:33: obstacles[0].mesh.data: invalid value \"abcde\" for type TYPE_BYTES");
}

TEST(SceneLoad, FewFillsWithoutRoomArePlaced) {
    const TemporaryFolder folder;
    const std::string full =
        R"({"fill": {"min": [0,0,0], "max": [1,1,1], "count": 1000}, "radius": {"constant": 0.1}})";
    const std::string json = cube("\"groups\": [" + full + "," + full + "," + full + "," + full + "," + full + "]");
    const std::vector<Error> mistakes = mistakesOf(folder.write("full.json", json));
    ASSERT_EQ(mistakes.size(), 3U);
    EXPECT_NE(mistakes[2].where.find("groups[2].fill.count"), std::string::npos) << mistakes[2].text();
}

TEST(SceneLoad, PlacedFillsAreInTheWayOfLaterGroups) {
    const TemporaryFolder folder;
    const std::string fill =
        R"({"fill": {"min": [0,0,0], "max": [0.3,0.3,0.3], "count": 1}, "radius": {"constant": 0.14}})";
    const std::string wrong = R"({"list": {"spheres": [{"position": [9,0,0]}]}, "radius": {"constant": 0.1}})";
    const std::string path = folder.write("two.json", cube("\"groups\": [" + fill + "," + wrong + "," + fill + "]"));
    const std::vector<Error> mistakes = mistakesOf(path);
    ASSERT_EQ(mistakes.size(), 2U);
    EXPECT_NE(mistakes[0].where.find("groups[1].list.spheres[0]"), std::string::npos) << mistakes[0].text();
    EXPECT_NE(mistakes[1].where.find("groups[2].fill.count"), std::string::npos) << mistakes[1].text();
}

TEST(SceneLoad, SleepCanBeTurnedOff) {
    EXPECT_TRUE(load("bounce", "gpu")->sleep.enabled);
    EXPECT_FALSE(load("bounce", "gpu", {.noSleep = true})->sleep.enabled);
}

}  // namespace
}  // namespace spherule::scene::testing
