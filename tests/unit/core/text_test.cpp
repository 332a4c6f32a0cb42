#include "core/text.h"

#include <gtest/gtest.h>

namespace spherule {
namespace {

TEST(Text, PlacesCountLinesAndCharacters) {
    const std::string text = "a\nm² b\n";
    EXPECT_EQ(lineAndColumn(text, 0), ":1:1");
    EXPECT_EQ(lineAndColumn(text, 1), ":1:2");
    EXPECT_EQ(lineAndColumn(text, 2), ":2:1");
    EXPECT_EQ(lineAndColumn(text, text.find('b')), ":2:4");
    EXPECT_EQ(lineAndColumn(text, text.size()), ":3:1");
    EXPECT_EQ(lineAndColumn(text, 99), ":3:1");
    EXPECT_EQ(lineAndColumn("", 0), ":1:1");
}

TEST(Text, PlacesInAnyOrderAreTheSame) {
    const std::string text = "a\nm² b\n";
    LineCounter lines(text);
    for (const std::size_t offset : {0U, 3U, 3U, 7U, 99U, 2U}) EXPECT_EQ(lines.at(offset), lineAndColumn(text, offset));
}

}  // namespace
}  // namespace spherule
