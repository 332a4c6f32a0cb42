#include <gtest/gtest.h>

#include <algorithm>

#include "compute/probe.h"
#include "test_device.h"

namespace spherule::compute {
namespace {

TEST(Probe, ListsTheDeviceAndItsLimits) {
    const auto result = probe(support::testDevice());
    ASSERT_TRUE(result.has_value()) << result.error().text();
    ASSERT_TRUE(result->chosen.has_value()) << result->problem;
    EXPECT_TRUE(support::testDevice().starts_with(result->chosen->kind)) << result->chosen->kind;
    ASSERT_TRUE(result->limits.has_value());
    EXPECT_EQ(result->limits->maxBufferBytes, static_cast<std::int64_t>(result->chosen->maxBufferBytes));
    EXPECT_GE(result->limits->storageBuffersPerKernel, 8);
    EXPECT_GE(result->limits->groupsX, 65535);
    EXPECT_GE(result->limits->groupInvocations, 64);
    EXPECT_TRUE(std::any_of(result->devices.begin(), result->devices.end(), [](const auto& d) {
        return d.choice.starts_with(support::testDevice()) && !d.renderer.empty();
    }));
    EXPECT_FALSE(result->vendors.empty());
}

TEST(Probe, TextAndJsonNameTheRenderer) {
    const auto result = probe(support::testDevice()).value();
    const auto text = probeText(result);
    EXPECT_NE(text.find(result.chosen->renderer), std::string::npos) << text;
    const auto json = probeJson(result);
    EXPECT_EQ(json.find('\n'), std::string::npos);
    EXPECT_NE(json.find("\"renderer\":\"" + result.chosen->renderer + "\""), std::string::npos) << json;
    EXPECT_NE(json.find("\"limits\":{\"maxBufferBytes\":"), std::string::npos) << json;
}

TEST(Probe, JsonOfAnEmptyProbeHasEveryKeyAndEscapes) {
    Probe nothing;
    nothing.choice = "gpu";
    nothing.problem = "a \"quoted\" problem\n";
    EXPECT_EQ(probeJson(nothing),
              R"({"choice":"gpu","chosen":null,"limits":null,"problem":"a \"quoted\" problem\n","hints":[],)"
              R"("devices":[],"vendors":[],"clientExtensions":""})");
}

TEST(Probe, MissingGpuIsAResultWithItsProblem) {
    const auto result = probe("gpu:99");
    ASSERT_TRUE(result.has_value());
    EXPECT_FALSE(result->chosen.has_value());
    EXPECT_NE(result->problem.find("gpu:99"), std::string::npos);
    EXPECT_NE(probeText(*result).find(result->problem), std::string::npos);
}

TEST(Probe, UnknownChoiceIsRefused) {
    const auto result = probe("fast");
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::Input);
}

}  // namespace
}  // namespace spherule::compute
