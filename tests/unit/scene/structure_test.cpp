#include <gtest/gtest.h>

#include "core/text.h"
#include "scene/structure.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

// Returns the mistakes, a line each: ":line:column path: message".
std::string mistakesOfText(std::string_view text) {
    std::string lines;
    for (const Mistake& one : structureOf(text).mistakes)
        lines += lineAndColumn(text, one.offset) + " " + one.path + (one.path.empty() ? "" : ": ") + one.message + "\n";
    return lines;
}

// Returns the mistakes of a scene in the unit cube with these members, which begin in the second line.
std::string mistakesWith(std::string_view members) {
    return mistakesOfText(std::string("{\"bounds\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]},\n").append(members) +
                          "}");
}

TEST(SceneStructure, RightScenesHaveNoMistakes) {
    EXPECT_EQ(mistakesWith(R"("$schema": "a.json", "gravity": [0, 0, -1e1])"), "");
    EXPECT_EQ(mistakesWith(
                  R"("groups": [{"fill": {"min": [0,0,0], "max": [1,1,1], "count": 3, "seed": "18446744073709551615"},
        "radius": {"constant": 0.1}}], "quality": {"model": "FAST", "auto": {}}, "sphereContacts": false)"),
              "");
    EXPECT_EQ(mistakesWith(R"("camera": {"field_of_view": 40})"), "") << "a name as in scene.proto";
}

TEST(SceneStructure, UnknownFieldsAreSuggested) {
    EXPECT_EQ(mistakesWith(R"("groups": [{"list": {}, "radius": {"constnat": 0.1}}])"),
              ":2:36 groups[0].radius.constnat: is not a field of Radius; did you mean \"constant\"?\n");
    EXPECT_EQ(mistakesWith(R"("colour": {"red": [1, {"a": 2}]}, "step": 0)"),
              ":2:1 colour: is not a field of Scene\n"
              ":2:43 step: is 0, must be 1e-06 to 1 s\n");
}

TEST(SceneStructure, WrongTypesAreNamed) {
    EXPECT_EQ(mistakesWith(R"("step": "1")"), ":2:9 step: is \"1\", must be a number\n");
    EXPECT_EQ(mistakesWith(R"("step": null)"), ":2:9 step: is null, must be a number\n");
    EXPECT_EQ(mistakesWith(R"("step": [1])"), ":2:9 step: is a list, must be a number\n");
    EXPECT_EQ(mistakesWith(R"("step": {"a": 1})"), ":2:9 step: is an object, must be a number\n");
    EXPECT_EQ(mistakesWith(R"("sphereContacts": 1)"), ":2:19 sphereContacts: is 1, must be true or false\n");
    EXPECT_EQ(mistakesWith(R"("name": 7)"), ":2:9 name: is 7, must be a text\n");
    EXPECT_EQ(mistakesWith(R"("groups": {})"), ":2:11 groups: is an object, must be a list\n");
    EXPECT_EQ(mistakesWith(R"("groups": [3])"), ":2:12 groups[0]: is 3, must be an object\n");
    EXPECT_EQ(mistakesWith(R"("sleep": true)"), ":2:10 sleep: is true, must be an object\n");
    EXPECT_EQ(mistakesWith(R"("quality": {"substeps": 1.5})"),
              ":2:25 quality.substeps: is 1.5, must be a whole number, not negative\n");
    EXPECT_EQ(mistakesOfText("[1, [2]]"), ":1:1 is a list, must be an object\n");
    EXPECT_EQ(mistakesOfText(" 7"), ":1:2 is 7, must be an object\n");
}

TEST(SceneStructure, ValuesFollowTheRules) {
    EXPECT_EQ(mistakesWith(R"("gravity": [0, 0])"), ":2:12 gravity: has 2 numbers, must have three: x, y, z\n");
    EXPECT_EQ(mistakesWith(R"("gravity": [0, "a", 1e10])"),
              ":2:16 gravity[1]: is \"a\", must be a number\n"
              ":2:21 gravity[2]: is 10000000000, must be -1000000000 to 1000000000 m/s²\n");
    EXPECT_EQ(mistakesWith(R"("sleep": {"time": 0})"), ":2:19 sleep.time: is 0, must be above 0 s\n");
    EXPECT_EQ(mistakesWith(R"("sleep": {"time": 3601})"), ":2:19 sleep.time: is 3601, must be at most 3600 s\n");
    EXPECT_EQ(mistakesWith(R"("quality": {"substeps": -1})"),
              ":2:25 quality.substeps: is -1, must be 1 to 1000000 per step\n");
    EXPECT_EQ(mistakesWith(R"("light": {"colour": "red"})"),
              ":2:21 light.colour: is \"red\", must be #rrggbb in hexadecimal\n");
    EXPECT_EQ(mistakesWith(R"("quality": {"model": "BALANCE"})"),
              ":2:22 quality.model: is \"BALANCE\", must be one of FAST, BALANCED, ACCURATE; did you mean "
              "\"BALANCED\"?\n");
    EXPECT_EQ(mistakesWith(R"("quality": {"model": 1})"),
              ":2:22 quality.model: is 1, must be one of FAST, BALANCED, ACCURATE\n");
    std::string nine = R"({"drag": {}})";
    for (int k = 0; k < 8; ++k) nine += R"(, {"drag": {}})";
    EXPECT_EQ(mistakesWith("\"fields\": [" + nine + "]"), ":2:11 fields: has 9 entries, must have at most 8\n");
    EXPECT_EQ(mistakesWith("\"name\": \"" + std::string(201, 'n') + "\""),
              ":2:9 name: is 201 bytes long, must be at most 200\n");
}

TEST(SceneStructure, WholeNumbersFitTheirBits) {
    const auto withSeed = [](const std::string& seed) {
        return mistakesWith(R"("groups": [{"fill": {"min": [0,0,0], "max": [1,1,1], "count": 3, "seed": )" + seed +
                            "}}]");
    };
    for (const char* right : {"0", "18446744073709551615", "\"0\"", "\"18446744073709551615\""})
        EXPECT_EQ(withSeed(right), "") << right;
    for (const char* wrong :
         {"18446744073709551616", "\"18446744073709551616\"", "-1", "\"-1\"", "1.5", "\"\"", "\" 1\""})
        EXPECT_TRUE(withSeed(wrong).starts_with(":2:74 groups[0].fill.seed: is ")) << wrong << withSeed(wrong);
    EXPECT_EQ(mistakesWith(R"("groups": [{"fill": {"min": [0,0,0], "max": [1,1,1], "count": 4294967296}}])"),
              ":2:63 groups[0].fill.count: is 4294967296, must be at most 4294967295\n");
}

TEST(SceneStructure, BytesAreBase64) {
    EXPECT_EQ(mistakesWith(R"("obstacles": [{"mesh": {"data": "diAwIDAgMAo="}}])"), "");
    EXPECT_EQ(mistakesWith(R"("obstacles": [{"mesh": {"data": "a b"}}])"),
              ":2:33 obstacles[0].mesh.data: is not Base64\n");
}

TEST(SceneStructure, MissingAndDoubledFieldsAreNamed) {
    EXPECT_EQ(mistakesOfText("{}"), ":1:1 bounds: is missing; it must be an object\n");
    EXPECT_EQ(mistakesOfText("{\n \"bounds\": {\"min\": [0,0,0]}}"),
              ":2:12 bounds.max: is missing; it must be three numbers: x, y, z\n");
    EXPECT_EQ(mistakesWith(R"("groups": [{}])"),
              ":2:12 groups[0]: has none of list, lattice, fill, csv, xyz, lammps; give one of them\n");
    EXPECT_EQ(mistakesWith(R"("groups": [{"list": {}, "csv": {"file": "a"}}])"),
              ":2:25 groups[0].csv: is beside `list`; Group has only one of list, lattice, fill, csv, xyz, lammps\n");
    EXPECT_EQ(mistakesWith(R"("step": 0.1, "step": 0.2)"), ":2:14 step: is given twice\n");
    EXPECT_EQ(mistakesWith(R"("camera": {"fieldOfView": 30, "field_of_view": 31})"),
              ":2:31 camera.fieldOfView: is given twice\n");
    EXPECT_EQ(mistakesOfText("{\"bound\": {}}"), ":1:2 bound: is not a field of Scene; did you mean \"bounds\"?\n")
        << "a field that is misspelt is not missing, too";
}

TEST(SceneStructure, SyntaxErrorsHaveTheirPlace) {
    const auto beginsWith = [](const std::string& text, std::string_view place) {
        const std::string found = mistakesOfText(text);
        EXPECT_TRUE(found.starts_with(std::string(place) + " is not JSON: ")) << text.substr(0, 80) << "\n" << found;
    };
    beginsWith("{\n  \"gravity\": [1, 2, 3\n  \"bounds\": {}\n}", ":3:3");
    beginsWith("{\n  \"gravity\": [1, NaN]}", ":2:18");
    beginsWith("{\n", ":2:1");
    beginsWith("", ":1:1");
    beginsWith("{\"gravity\": [1,,2]}", ":1:16");
    beginsWith("{\"groups\": [{\"list\" 1}]}", ":1:21");
    beginsWith("{\"description\": \"m²\" 1}", ":1:22");
    EXPECT_EQ(mistakesOfText("{\"step\": 5,\n\"sleep\": }"),
              ":1:10 step: is 5, must be 1e-06 to 1 s\n"
              ":2:10 is not JSON: unexpected '}'; expected '[', '{', or a literal\n");
    beginsWith("{\"name\": \"a\nb\"}", ":1:12");
    EXPECT_TRUE(mistakesOfText("{\"groups\": " + std::string(1'000'000, '['))
                    .ends_with("unexpected end of input; expected '[', '{', or a literal\n"));
}

TEST(SceneStructure, SearchEndsAfterManyMistakes) {
    std::string many = "\"a\": 1";
    for (int k = 0; k < 3000; ++k) many += ", \"a\": 1";
    const Structure found = structureOf(object(many));
    EXPECT_EQ(found.mistakes.size(), mostMistakes);
    EXPECT_FALSE(found.wholeRead);
}

TEST(SceneStructure, PathsHavePlaces) {
    const std::string text =
        "{\n\"groups\": [{\"list\": {}},\n {\"radius\": {\"constant\": 1}, \"list\": {}}],\n\"step\": 1}";
    TextPlaces places;
    const std::vector<std::string> paths{"groups[1].radius.constant",
                                         "groups[1].radius",
                                         "groups[1].material",
                                         "groups[1]",
                                         "step",
                                         "ste",
                                         "groups[12]",
                                         ""};
    for (const std::string& path : paths) places.add(path);
    find(places, text);
    const auto place = [&](std::string_view path) { return lineAndColumn(text, places.offsetOf(path)); };
    EXPECT_EQ(place("groups[1].radius.constant"), ":3:26");
    EXPECT_EQ(place("groups[1].radius"), ":3:13");
    EXPECT_EQ(place("groups[1].material"), ":3:2") << "what contains it";
    EXPECT_EQ(place("groups[1]"), ":3:2");
    EXPECT_EQ(place("step"), ":4:9");
    EXPECT_EQ(place("ste"), ":1:1");
    EXPECT_EQ(place("groups[12]"), ":2:11");
    EXPECT_EQ(place(""), ":1:1");
}

// Returns the text without its mistakes.
std::string rest(std::string_view text) {
    return withoutCuts(text, structureOf(text).cuts);
}

TEST(SceneStructure, WrongMembersAreCut) {
    EXPECT_EQ(rest(R"({"step": 2, "name": "a"})"), R"({ "name": "a"})");
    EXPECT_EQ(rest(R"({"name": "a", "step": 2})"), R"({"name": "a"})");
    EXPECT_EQ(rest(R"({"name": "a", "step": 2 , "camera": {}})"), R"({"name": "a" , "camera": {}})");
    EXPECT_EQ(rest("{\"step\": -1}"), "{}");
    EXPECT_EQ(rest(R"({"step": "a,}", "name": 7, "gravity": {"a": [1]}})"), "{}") << "neighbours";
    EXPECT_EQ(rest(R"({"a": [{"step": 2}], "name": "b"})"), R"({ "name": "b"})") << "unknown";
    EXPECT_EQ(rest(R"({"step": 0.1, "step": 0.2})"), R"({"step": 0.1})");
    EXPECT_EQ(rest(R"({"groups": [{"list": {}, "csv": {"fil": "a"}}]})"), R"({"groups": [{"list": {}}]})");
    EXPECT_EQ(rest(R"({"sleep": {"enabled": 1}, "light": [2]})"), R"({"sleep": {}})");
}

TEST(SceneStructure, WrongEntriesOfListsAreReplaced) {
    EXPECT_EQ(rest(R"({"groups": [3, {"list": {}}, "a", [{}]]})"), R"({"groups": [{}, {"list": {}}, {}, {}]})");
    EXPECT_EQ(rest(R"({"gravity": [0, "a", 1], "name": "b"})"), R"({ "name": "b"})") << "a list of numbers is cut";
    EXPECT_EQ(rest(R"({"gravity": [0, 1], "name": "b"})"), R"({ "name": "b"})");
    EXPECT_EQ(rest(R"({"bounds": {"open": ["X_MIN", "X"]}})"), R"({"bounds": {}})");
}

TEST(SceneStructure, OtherMessagesWithTheFieldAreNamed) {
    EXPECT_EQ(mistakesWith(R"("groups": [{"list": {}, "friction": 0.2}])"),
              ":2:25 groups[0].friction: is not a field of Group; Material and MaterialPair have one of this name\n");
    EXPECT_EQ(mistakesWith(R"("young": 1e7)"), ":2:1 young: is not a field of Scene; Material has one of this name\n");
    EXPECT_EQ(mistakesWith(R"("radius": 1e7)"), ":2:1 radius: is not a field of Scene\n") << "many have one";
}

}  // namespace
}  // namespace spherule::scene::testing
