#include "core/text.h"

#include <gtest/gtest.h>

#include "core/suggestion.h"

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

TEST(Suggestion, IsTheNearestName) {
    const std::vector<std::string> names{"step", "sleep", "spin"};
    EXPECT_EQ(suggestionFor("stepp", names), "step");
    EXPECT_EQ(suggestionFor("seep", names), "step") << "the first of equally near ones";
    EXPECT_EQ(suggestionFor("gravity", names), std::nullopt);
    EXPECT_EQ(suggestionFor("", names), std::nullopt);
    EXPECT_EQ(suggestionFor("x", {}), std::nullopt);
    EXPECT_EQ(suggestionFor(std::string(1000, 's'), names), std::nullopt);
}

}  // namespace
}  // namespace spherule
