#include "core/suggestion.h"

#include <gtest/gtest.h>

#include <vector>

namespace spherule {
namespace {

TEST(Suggestion, IsTheNearestName) {
    const std::vector<std::string> names{"step", "sleep", "spin"};
    EXPECT_EQ(suggestionFor("stepp", names), "step");
    EXPECT_EQ(suggestionFor("seep", names), "step") << "the first of equally near ones";
    EXPECT_EQ(suggestionFor("gravity", names), std::nullopt);
    EXPECT_EQ(suggestionFor("", names), std::nullopt);
    EXPECT_EQ(suggestionFor("--", names), std::nullopt);
    EXPECT_EQ(suggestionFor("x", {}), std::nullopt);
    EXPECT_EQ(suggestionFor(std::string(1000, 's'), names), std::nullopt);
}

TEST(Suggestion, HasNoRegardToCaseAndSeparators) {
    const std::vector<std::string> names{"BALANCED", "A_B_C_D", "fieldOfView", "--max-speed"};
    EXPECT_EQ(suggestionFor("balanced", names), "BALANCED");
    EXPECT_EQ(suggestionFor("abcd", names), "A_B_C_D");
    EXPECT_EQ(suggestionFor("FIELD-OF-VIEW", names), "fieldOfView");
    EXPECT_EQ(suggestionFor("--maxspeed", names), "--max-speed");
}

TEST(Suggestion, SwappedNeighboursAreOneEdit) {
    const std::vector<std::string> names{"xz", "abcdef"};
    EXPECT_EQ(suggestionFor("zx", names), "xz");
    EXPECT_EQ(suggestionFor("bacdfe", names), "abcdef") << "two swaps";
    EXPECT_EQ(suggestionFor("badcfe", names), std::nullopt) << "three";
}

TEST(Suggestion, LongWordsMayHaveMoreEdits) {
    const std::vector<std::string> names{"rollingresistance", "size"};
    EXPECT_EQ(suggestionFor("ollinrsistane", names), "rollingresistance") << "4 of 13";
    EXPECT_EQ(suggestionFor("ollinrsistan", names), std::nullopt) << "5 of 12";
    EXPECT_EQ(suggestionFor("siabc", names), std::nullopt) << "3 of 5";
    EXPECT_EQ(suggestionFor("s", names), std::nullopt) << "all of a word";
}

TEST(Suggestion, MayBeginLikeTheWord) {
    const std::vector<std::string> names{"gravity", "restitution", "step", "rollingResistance", "spin"};
    EXPECT_EQ(suggestionFor("gravitation", names), "gravity");
    EXPECT_EQ(suggestionFor("graviton_of_the_earth", names), "gravity") << "five letters";
    EXPECT_EQ(suggestionFor("graves_of_spheres", names), std::nullopt) << "four letters";
    EXPECT_EQ(suggestionFor("rest", names), "restitution");
    EXPECT_EQ(suggestionFor("stepDuration", names), "step");
    EXPECT_EQ(suggestionFor("rollingFriction", names), "rollingResistance");
}

}  // namespace
}  // namespace spherule
