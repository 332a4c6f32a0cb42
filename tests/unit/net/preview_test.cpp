#include "net/preview.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include <google/protobuf/util/json_util.h>

namespace spherule::net {
namespace {

constexpr std::size_t most = std::size_t{1} << 40U;

std::string text(const v1::ClientMessage& message) {
    std::string json;
    EXPECT_TRUE(google::protobuf::util::MessageToJsonString(message, &json).ok());
    return json;
}

// A load command whose scene has `count` copies of one element.
template <class Add>
v1::ClientMessage loadOf(int count, Add add) {
    v1::ClientMessage message;
    message.mutable_command()->set_id(42);
    for (int k = 0; k < count; ++k) add(*message.mutable_command()->mutable_load()->mutable_scene());
    return message;
}

// The memory of the parsed message, and the estimate from its wire form.
void expectCovered(const v1::ClientMessage& message, const char* what) {
    const std::string binary = message.SerializeAsString();
    v1::ClientMessage parsed;
    ASSERT_TRUE(parsed.ParseFromString(binary));
    for (const auto& preview :
         {previewOf(binary, Encoding::Binary, most), previewOf(text(message), Encoding::Text, most)}) {
        EXPECT_GE(preview.cost, parsed.SpaceUsedLong()) << what;
        EXPECT_LE(preview.cost, 16 * parsed.SpaceUsedLong() + 1000) << what;
        EXPECT_TRUE(preview.command) << what;
        EXPECT_EQ(preview.id, 42U) << what;
    }
}

TEST(Preview, CostIsAtLeastTheMemoryOfTheParsedMessage) {
    for (const int count : {1, 1000, 100'000}) {
        expectCovered(loadOf(count, [](v1::Scene& scene) { scene.add_groups(); }), "empty groups");
        expectCovered(loadOf(count, [](v1::Scene& scene) { scene.add_obstacles()->mutable_box(); }), "empty boxes");
        expectCovered(loadOf(count, [](v1::Scene& scene) { scene.add_materials(); }), "empty materials");
        expectCovered(loadOf(count, [](v1::Scene& scene) { scene.add_gravity(1); }), "numbers");
        expectCovered(loadOf(count, [](v1::Scene& scene) { scene.mutable_bounds()->add_open(v1::X_MIN); }), "faces");
        expectCovered(loadOf(count,
                             [](v1::Scene& scene) {
                                 if (scene.groups().empty()) scene.add_groups()->mutable_radius()->set_constant(0.1);
                                 v1::Sphere& sphere = *scene.mutable_groups(0)->mutable_list()->add_spheres();
                                 for (int axis = 0; axis < 3; ++axis) sphere.add_position(0.125);
                             }),
                      "spheres");
    }
    expectCovered(loadOf(1, [](v1::Scene& scene) { scene.set_description(std::string(100'000, 'd')); }), "text");
}

TEST(Preview, CountsUnknownFields) {
    std::string bytes;
    for (int k = 0; k < 10'000; ++k) bytes += std::string("\xf8\x07\x01", 3);  // field 127: 1
    v1::ClientMessage parsed;
    ASSERT_TRUE(parsed.ParseFromString(bytes));
    EXPECT_GE(previewOf(bytes, Encoding::Binary, most).cost, parsed.SpaceUsedLong());
}

TEST(Preview, IgnoresBracketsInStrings) {
    const std::string json = R"({ "command" : { "set": {"id": 3}, "id" : "18446744073709551615",
        "load": {"scene": {"description": "{{{,,,\"id\": 4,\"", "name": "}"}}}})";
    const Preview preview = previewOf(json, Encoding::Text, most);
    EXPECT_TRUE(preview.command);
    EXPECT_EQ(preview.id, 18446744073709551615U);
    EXPECT_LT(preview.cost, 2500U);
    EXPECT_FALSE(previewOf(R"({"view":{"rate":3}})", Encoding::Text, most).command);
    EXPECT_FALSE(previewOf(R"({"view":{"command":{"id":3}}})", Encoding::Text, most).command);
}

TEST(Preview, StopsAtTheLimit) {
    const std::string bytes = loadOf(100'000, [](v1::Scene& scene) { scene.add_groups(); }).SerializeAsString();
    const std::size_t cost = previewOf(bytes, Encoding::Binary, 10'000).cost;
    EXPECT_GT(cost, 10'000U);
    EXPECT_LT(cost, 11'000U);
}

TEST(Preview, TerminatesForAnyInput) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        std::mt19937 random(seed);
        for (int round = 0; round < 2000; ++round) {
            std::string bytes(random() % 200, '\0');
            for (char& c : bytes) c = static_cast<char>(random());
            (void)previewOf(bytes, Encoding::Binary, most);
            (void)previewOf(bytes, Encoding::Text, most);
        }
    }
}

}  // namespace
}  // namespace spherule::net
