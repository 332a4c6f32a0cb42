#include "compute/source.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "map_sources.h"

namespace spherule::compute {
namespace {

TEST(KernelSources, LinesKeepTheirOrigin) {
    const MapSources sources{{"a.comp", "one\n  # include \"b.h\"  \nthree"}, {"b.h", "inner\n"}};
    const std::array defines{Define{"F", "2"}};
    const auto expanded = expandSource(sources, "a.comp", defines);
    ASSERT_TRUE(expanded.has_value()) << expanded.error().text();
    EXPECT_EQ(expanded->text,
              "#version 450 core\n#line 1 0\n#define F 2\n"
              "#line 100001 1\none\n#line 200001 2\ninner\n#line 100003 1\nthree\n");
    EXPECT_EQ(expanded->files, (std::vector<std::string>{"<defines>", "a.comp", "b.h"}));
}

TEST(KernelSources, FileIncludedTwiceIsExpandedTwiceUnderOneIndex) {
    const MapSources sources{{"a.comp", "#include \"b.h\"\n#include \"b.h\"\n"}, {"b.h", "x\n"}};
    const auto expanded = expandSource(sources, "a.comp", {});
    ASSERT_TRUE(expanded.has_value()) << expanded.error().text();
    EXPECT_EQ(expanded->files.size(), 3U);
    EXPECT_NE(expanded->text.find("#line 200001 2\nx\n#line 100002 1\n#line 200001 2\nx\n"), std::string::npos)
        << expanded->text;
}

TEST(KernelSources, OnlyQuotedIncludesAreExpanded) {
    const MapSources sources{{"a.comp", "#include <glm/glm.hpp>\n// #include \"b.h\"\n#includes \"b.h\"\n"}};
    const auto expanded = expandSource(sources, "a.comp", {});
    ASSERT_TRUE(expanded.has_value()) << expanded.error().text();
    EXPECT_NE(expanded->text.find("#include <glm/glm.hpp>\n// #include \"b.h\"\n#includes \"b.h\"\n"),
              std::string::npos);
}

TEST(KernelSources, CycleIsRefusedWithItsPath) {
    const MapSources sources{
        {"a.comp", "\n#include \"b.h\"\n"}, {"b.h", "#include \"c.h\"\n"}, {"c.h", "\n\n#include \"b.h\"\n"}};
    const auto expanded = expandSource(sources, "a.comp", {});
    ASSERT_FALSE(expanded.has_value());
    EXPECT_EQ(expanded.error().text(), "c.h:3: \"b.h\" includes itself by way of a.comp -> b.h -> c.h");
}

TEST(KernelSources, MissingFileIsNamedWithItsInclude) {
    const MapSources sources{{"a.comp", "\n#include \"lost.h\"\n"}};
    const auto expanded = expandSource(sources, "a.comp", {});
    ASSERT_FALSE(expanded.has_value());
    EXPECT_EQ(expanded.error().where, "a.comp:2");
    EXPECT_NE(expanded.error().message.find("lost.h"), std::string::npos);
    EXPECT_FALSE(expandSource(sources, "lost.comp", {}).has_value());
}

TEST(KernelSources, BuffersAreDeclaredAtTheNextFreeBinding) {
    const MapSources sources{{"a.comp", "BUFFER(readonly, vec4, position)  // m\n#include \"b.h\"\n"},
                             {"b.h", "BUFFER(coherent, uint, counters)\n"}};
    const auto expanded = expandSource(sources, "a.comp", {});
    ASSERT_TRUE(expanded.has_value()) << expanded.error().text();
    EXPECT_NE(
        expanded->text.find("layout(std430, binding = 0) readonly buffer positionBlock { vec4 position[]; };  // m\n"),
        std::string::npos)
        << expanded->text;
    EXPECT_NE(expanded->text.find("layout(std430, binding = 1) coherent buffer countersBlock { uint counters[]; };\n"),
              std::string::npos);
    ASSERT_EQ(expanded->buffers.size(), 2U);
    EXPECT_EQ(expanded->buffers[0].type, "vec4");
    EXPECT_EQ(expanded->buffers[1].name, "counters");
}

TEST(KernelSources, BuffersThatCannotBeDeclaredAreRefusedWithTheirLine) {
    std::string many;
    for (std::size_t k = 0; k <= maxKernelBuffers; ++k) many += "BUFFER(readonly, uint, b" + std::to_string(k) + ")\n";
    const std::pair<std::string, const char*> cases[] = {
        {many, "a.comp:17: declares b16 as buffer 17 of its kernel; a kernel has at most 16"},
        {"BUFFER(readonly, uint, b)\nBUFFER(restrict, vec4, b)\n", "a.comp:2: declares the buffer b a second time"},
        {"BUFFER(0, readonly, uint, b)\n", "a.comp:1: is not of the form BUFFER(access, type, name)"},
        {"BUFFER(readonly, uint)\n", "a.comp:1: is not of the form BUFFER(access, type, name)"},
        {"BUFFER(readonly, uint, b\n", "a.comp:1: is not of the form BUFFER(access, type, name)"}};
    for (const auto& [text, message] : cases) {
        const MapSources sources{{"a.comp", text}};
        const auto expanded = expandSource(sources, "a.comp", {});
        ASSERT_FALSE(expanded.has_value()) << text;
        EXPECT_EQ(expanded.error().text(), message);
    }
}

TEST(KernelSources, MessagesOfAllCompilersNameTheFile) {
    const std::vector<std::string> files{"<defines>", "a.comp", "shared/b.h"};
    EXPECT_EQ(nameFiles("0:200012(5): error: `x' undeclared\n", files), "shared/b.h:12(5): error: `x' undeclared\n");
    EXPECT_EQ(nameFiles("1(100007) : error C1008: undefined\n", files), "a.comp:7 : error C1008: undefined\n");
    EXPECT_EQ(nameFiles("ERROR: 1:100003: 'x' : undeclared\nno place here\n9:900001(1): unknown file\n", files),
              "a.comp:3: 'x' : undeclared\nno place here\n9:900001(1): unknown file\n");
    EXPECT_EQ(nameFiles("0:2(9): error: bad define\n", files), "<defines>:2(9): error: bad define\n");
}

}  // namespace
}  // namespace spherule::compute
