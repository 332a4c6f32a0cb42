#include <filesystem>

#include <gtest/gtest.h>

#include "client/client.h"
#include "client/command_parser.h"
#include "client/ctl.h"
#include "client/url.h"
#include "temporary_folder.h"

namespace spherule::client {
namespace {

using Words = std::vector<std::string>;

std::string parsed(const Words& words) {
    const auto command = commandFrom(words);
    return command ? command->ShortDebugString() : "error: " + command.error().text();
}

TEST(CommandParser, ParsesEveryCommand) {
    EXPECT_EQ(parsed({"pause"}), "pause { }");
    EXPECT_EQ(parsed({"resume"}), "resume { }");
    EXPECT_EQ(parsed({"reset"}), "reset { }");
    EXPECT_EQ(parsed({"query"}), "query { }");
    EXPECT_EQ(parsed({"query", "hash"}), "query { hash: true }");
    EXPECT_EQ(parsed({"cancel"}), "cancel { }");
    EXPECT_EQ(parsed({"seek", "12.5"}), "seek { time: 12.5 }");
    EXPECT_EQ(parsed({"inspect", "12"}), "inspect { sphere: 12 }");
    EXPECT_EQ(parsed({"record"}), "start_recording { }");
    EXPECT_EQ(parsed({"record", "stop"}), "stop_recording { }");
    EXPECT_EQ(parsed({"step"}), "step { count: 1 }");
    EXPECT_EQ(parsed({"step", "25"}), "step { count: 25 }");
    EXPECT_EQ(parsed({"load", "box-10k"}), "load { name: \"box-10k\" }");
    EXPECT_EQ(parsed({"set", "gravity", "0", "0", "-1.6"}), "set { gravity: 0 gravity: 0 gravity: -1.6 }");
    EXPECT_EQ(parsed({"set", "restitution", "0.9"}), "set { restitution: 0.9 }");
    EXPECT_EQ(parsed({"set", "friction", "0.4"}), "set { friction: 0.4 }");
    EXPECT_EQ(parsed({"set", "model", "fast"}), "set { model: FAST }");
    EXPECT_EQ(parsed({"set", "model", "balanced"}), "set { model: BALANCED }");
    EXPECT_EQ(parsed({"set", "model", "accurate"}), "set { model: ACCURATE }");
    EXPECT_EQ(parsed({"set", "substeps", "16"}), "set { substeps: 16 }");
    EXPECT_EQ(parsed({"set", "auto", "16ms"}), "set { auto { budget_ms: 16 } }");
    EXPECT_EQ(parsed({"set", "auto", "0.5%"}), "set { auto { overlap: 0.005 } }");
    EXPECT_EQ(parsed({"set", "auto", "off"}), "set { auto { } }");
    EXPECT_EQ(parsed({"set", "speed", "0.25"}), "set { speed: 0.25 }");
    EXPECT_EQ(parsed({"push", "17", "0", "0", "2"}), "push { sphere: 17 impulse: 0 impulse: 0 impulse: 2 }");
    EXPECT_EQ(parsed({"push", "ray", "1", "2", "3", "4", "5", "6", "7", "8", "9"}),
              "push { ray { origin: 1 origin: 2 origin: 3 direction: 4 direction: 5 direction: 6 } "
              "impulse: 7 impulse: 8 impulse: 9 }");
    EXPECT_EQ(parsed({"spawn", R"({"list":{"spheres":[{"position":[0,0,1],"radius":0.1}]}})"}),
              "spawn { group { list { spheres { position: 0 position: 0 position: 1 radius: 0.1 } } } }");
    EXPECT_EQ(parsed({"add_obstacle", R"({"colour":"#ff0000"})"}), "add_obstacle { obstacle { colour: \"#ff0000\" } }");
    EXPECT_EQ(parsed({"add_field", R"({"drag":{"density":2}})"}), "add_field { field { drag { density: 2 } } }");
    EXPECT_EQ(parsed({"change_field", "3", R"({"drag":{}})"}), "change_field { number: 3 field { drag { } } }");
    EXPECT_EQ(parsed({"remove_field", "3"}), "remove_field { number: 3 }");
    EXPECT_EQ(parsed({"add_emitter", R"({"rate":2})"}), "add_emitter { emitter { rate: 2 } }");
    EXPECT_EQ(parsed({"change_emitter", "0", R"({"rate":2})"}), "change_emitter { emitter { rate: 2 } }");
    EXPECT_EQ(parsed({"remove_emitter", "1"}), "remove_emitter { number: 1 }");
    EXPECT_EQ(parsed({"add_material", R"({"name":"cork"})"}), "add_material { material { name: \"cork\" } }");
    EXPECT_EQ(parsed({"change_material", "1", R"({"name":"cork"})"}),
              "change_material { number: 1 material { name: \"cork\" } }");
    EXPECT_EQ(parsed({"remove_material", "1"}), "remove_material { number: 1 }");
    EXPECT_EQ(parsed({"set_pair", R"({"a":"cork","b":"ice"})"}), "set_pair { pair { a: \"cork\" b: \"ice\" } }");
    EXPECT_EQ(parsed({"change_group", "2", R"({"number":7,"material":"cork","metal":0})"}),
              "change_group { number: 2 material: \"cork\" metal: 0 }");
    EXPECT_EQ(parsed({"remove_group", "2"}), "remove_group { number: 2 }");
    EXPECT_EQ(parsed({R"({"id":3,"step":{"count":10}})"}), "id: 3 step { count: 10 }");
}

TEST(CommandParser, LoadsFileAsInlineScene) {
    const support::TemporaryFolder folder;
    const std::string path = folder.write("scene.json", R"({"name":"from a file"})");
    EXPECT_EQ(parsed({"load", path}), "load { scene { name: \"from a file\" } }");
    folder.write("scene.json", R"({"nam":"from a file"})");
    EXPECT_EQ(parsed({"load", path}).find("error: " + path + ": "), 0U);
    std::filesystem::remove(path);
    EXPECT_EQ(parsed({"load", path}),
              "error: " + path +
                  ": there is no such file; give the path of a scene file on this machine, which is sent, or the name "
                  "of a scene of the server, without .json");
}

TEST(CommandParser, ReportsAcceptedForms) {
    const std::vector<Words> wrong = {
        {},
        {"dance"},
        {"pause", "now"},
        {"query", "now"},
        {"query", "hash", "now"},
        {"seek"},
        {"seek", "soon"},
        {"seek", "1", "2"},
        {"inspect"},
        {"inspect", "-1"},
        {"inspect", "12", "13"},
        {"start_recording"},
        {"step", "many"},
        {"set", "auto", "16"},
        {"set", "auto", "fastms"},
        {"step", "-1"},
        {"step", "1.5"},
        {"step", "1", "2"},
        {"load"},
        {"set"},
        {"set", "colour", "red"},
        {"set", "gravity", "0", "0"},
        {"set", "gravity", "0", "0", "nan"},
        {"set", "gravity", "0", "0", "inf"},
        {"set", "speed", "1e999"},
        {"set", "speed", "1x"},
        {"set", "speed", ""},
        {"set", "friction"},
        {"set", "friction", "rough"},
        {"set", "model"},
        {"set", "model", "slow"},
        {"set", "model", "model_unspecified"},
        {"set", "model", "fast", "accurate"},
        {"add_field"},
        {"change_field", "{}"},
        {"change_field", "x", "{}"},
        {"change_group", "1"},
        {"remove_field"},
        {"push", "1", "2", "3"},
        {"push", "ray", "1", "2", "3"},
        {"{}"},
    };
    for (const Words& words : wrong) {
        const std::string text = parsed(words);
        EXPECT_EQ(text.find("error: "), 0U) << text;
        EXPECT_NE(text.find("set gravity X Y Z"), std::string::npos) << text;
    }
    EXPECT_EQ(parsed({"spawn", R"({"listt":{}})"}).find("error: spawn: "), 0U);
    EXPECT_EQ(parsed({R"({"pause":{"x":1}})"}).find("error: command: "), 0U);
}

TEST(CommandResult, IsReadable) {
    v1::CommandResult result;
    result.mutable_refused()->set_field("set.speed");
    result.mutable_refused()->set_reason("-1 is negative");
    EXPECT_EQ(resultText(result), "refused: set.speed: -1 is negative");
    result.mutable_applied()->set_step(12);
    result.mutable_applied()->set_sphere(0);
    EXPECT_EQ(resultText(result), "applied at step 12, hit sphere 0");
    result.mutable_applied()->clear_sphere();
    result.mutable_applied()->mutable_statistics()->set_spheres(5);
    const std::string text = resultText(result);
    EXPECT_TRUE(text.starts_with('{') && text.ends_with("}\n")) << "JSON alone: " << text;
    EXPECT_NE(text.find("\"spheres\": 5"), std::string::npos) << text;
    EXPECT_NE(text.find("\"contacts\": \"0\""), std::string::npos) << text;
}

TEST(CommandResult, ReplacesControlCharacters) {
    v1::CommandResult result;
    result.mutable_refused()->set_field("\x1b]0;title\x07");
    result.mutable_refused()->set_reason(
        "\x1b[2J red\r \xc2\x9b"
        "31m zu gro\xc3\x9f \x7f\nnext");
    EXPECT_EQ(resultText(result), "refused: ?]0;title?: ?[2J red? ?31m zu gro\xc3\x9f ?\nnext");
}

TEST(Url, ParsesParts) {
    const auto full = parseUrl("ws://example.org:8080/ws");
    ASSERT_TRUE(full);
    EXPECT_EQ(full->host, "example.org");
    EXPECT_EQ(full->port, "8080");
    EXPECT_EQ(full->path, "/ws");
    const auto brief = parseUrl("ws://[::1]");
    ASSERT_TRUE(brief);
    EXPECT_EQ(brief->host, "::1");
    EXPECT_EQ(brief->port, "80");
    EXPECT_EQ(brief->path, "/ws");
    EXPECT_EQ(parseUrl("ws://[::1]:81/x")->port, "81");
    EXPECT_FALSE(brief->secure);
    const auto secure = parseUrl("wss://localhost");
    ASSERT_TRUE(secure);
    EXPECT_TRUE(secure->secure);
    EXPECT_EQ(secure->port, "443");
    for (const std::string wrong :
         {"", "localhost:8080", "http://localhost", "https://localhost", "ws://", "ws://:80"}) {
        EXPECT_FALSE(parseUrl(wrong)) << wrong;
    }
}

}  // namespace
}  // namespace spherule::client
