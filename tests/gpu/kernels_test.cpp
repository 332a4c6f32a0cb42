#include <array>

#include "device_fixture.h"

namespace spherule::compute {
namespace {

TEST_F(DeviceTest, KernelUsesIncludesAndDefines) {
    const MapSources sources{
        {"add.comp",
         "#include \"shared/head.h\"\n#include \"shared/law.h\"\n"
         "layout(std430, binding = 0) buffer Values { uint values[]; };\n"
         "void main() { uint i = self(); if (i < invocations) values[i] = law(i); }\n"},
        {"shared/head.h", kernelHead},
        {"shared/law.h", "uint law(uint i) { return FACTOR * i + phase; }\n"},
    };
    const std::array defines{Define{"FACTOR", "3u"}};
    const auto law = device_->createKernel(sources, "add.comp", defines);
    ASSERT_TRUE(law.has_value()) << law.error().text();
    EXPECT_EQ((*law)->name(), "add.comp");
    const auto values = buffer(16);
    launch(**law, 3, {values.get()}, 100);
    EXPECT_EQ(contents(*values), (std::vector<std::uint32_t>{100, 103, 106, 0}));
}

TEST_F(DeviceTest, CompileErrorNamesFileAndLine) {
    const MapSources sources{
        {"bad.comp", "#include \"shared/head.h\"\n#include \"shared/broken.h\"\nvoid main() {}\n"},
        {"shared/head.h", kernelHead},
        {"shared/broken.h", "float fine() { return 1.0; }\n\nfloat broken() { return unheardOf; }\n"},
    };
    const auto result = device_->createKernel(sources, "bad.comp", {});
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::Input);
    EXPECT_EQ(result.error().where, "bad.comp");
    EXPECT_NE(result.error().message.find("shared/broken.h:3"), std::string::npos) << result.error().text();
    EXPECT_NE(result.error().message.find("unheardOf"), std::string::npos) << result.error().text();
}

TEST_F(DeviceTest, CompileErrorAfterAnIncludeNamesTheLineOfTheIncludingFile) {
    const MapSources sources{
        {"bad.comp", "#include \"shared/head.h\"\nvoid main() {\n    wrong = 1;\n}\n"},
        {"shared/head.h", kernelHead},
    };
    const auto result = device_->createKernel(sources, "bad.comp", {});
    ASSERT_FALSE(result.has_value());
    EXPECT_NE(result.error().message.find("bad.comp:3"), std::string::npos) << result.error().text();
}

TEST_F(DeviceTest, ParametersAreBoundAsTheUniformBlock) {
    const auto scale = kernel(R"(
        layout(std140, binding = 0) uniform Parameters { uint factor; uint offset; };
        layout(std430, binding = 2) buffer Values { uint values[]; };
        void main() { uint i = self(); if (i < invocations) values[i] = factor * i + offset; })");
    const auto parameters = buffer(std::vector<std::uint32_t>{5, 1});
    const auto values = buffer(12);
    const std::array<Buffer*, 3> buffers{nullptr, nullptr, values.get()};
    Launch launch;
    launch.kernel = scale.get();
    launch.buffers = buffers;
    launch.parameters = parameters.get();
    launch.count = 3;
    device_->launch(launch);
    EXPECT_EQ(contents(*values), (std::vector<std::uint32_t>{1, 6, 11}));

    const std::vector<std::uint32_t> changed{7, 2};
    device_->upload(*parameters, 0, std::as_bytes(std::span(changed)));
    device_->launch(launch);
    EXPECT_EQ(contents(*values), (std::vector<std::uint32_t>{2, 9, 16}));
}

TEST_F(DeviceTest, KernelWithoutPhaseAndCountRuns) {
    const auto ones = kernel(R"(
        layout(std430, binding = 0) buffer Values { uint values[]; };
        void main() { if (self() < 2u) values[self()] = 1u; })");
    const auto values = buffer(12);
    launch(*ones, 3, {values.get()}, 9);
    EXPECT_EQ(contents(*values), (std::vector<std::uint32_t>{1, 1, 0}));
}

TEST_F(DeviceTest, KernelWithOneInvocationPerGroupRunsOncePerElement) {
    constexpr std::uint32_t count = 70000;  // more work groups than one row of a launch has
    const MapSources sources{{"single.comp", R"(
        layout(local_size_x = 1) in;
        layout(location = 1) uniform uint invocations;
        layout(std430, binding = 0) buffer Values { uint values[]; };
        void main() {
            uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x;
            if (i < invocations) values[i] += i + 1u;
        })"}};
    const auto single = device_->createKernel(sources, "single.comp", {});
    ASSERT_TRUE(single.has_value()) << single.error().text();
    const auto values = buffer((count + 1) * 4);
    launch(**single, count, {values.get()});
    const auto got = contents(*values);
    std::uint32_t wrong = 0;
    for (std::uint32_t i = 0; i < count; ++i) wrong += got[i] == i + 1 ? 0 : 1;
    EXPECT_EQ(wrong, 0U);
    EXPECT_EQ(got[count], 0U);
}

TEST_F(DeviceTest, KernelsThatViolateTheConventionsAreRefused) {
    const std::array<std::pair<const char*, const char*>, 4> cases{{
        {"layout(local_size_x = 32) in;\nvoid main() {}", "local size of 32 x 1 x 1"},
        {"layout(local_size_x = 64) in;\nlayout(std140, binding = 3) uniform P { uint p; };\n"
         "layout(std430, binding = 0) buffer V { uint v[]; };\nvoid main() { v[0] = p; }",
         "binding 0"},
        {"layout(local_size_x = 64) in;\nlayout(std430, binding = 16) buffer Far { uint v[]; };\n"
         "void main() { v[0] = 1u; }",
         "Far at slot 16"},
        {"layout(local_size_x = 64) in;\nlayout(std430, binding = 1) buffer A { uint a[]; };\n"
         "layout(std430, binding = 1) buffer B { uint b[]; };\nvoid main() { a[0] = b[1]; }",
         "at slot 1"},
    }};
    for (const auto& [text, expected] : cases) {
        const MapSources sources{{"odd.comp", text}};
        const auto result = device_->createKernel(sources, "odd.comp", {});
        ASSERT_FALSE(result.has_value()) << text;
        EXPECT_NE(result.error().message.find(expected), std::string::npos) << result.error().text();
    }
}

}  // namespace
}  // namespace spherule::compute
