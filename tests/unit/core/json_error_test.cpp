#include "core/json_error.h"

#include <gtest/gtest.h>

namespace spherule {
namespace {

TEST(JsonErrors, SyntaxErrorsHaveLineAndColumn) {
    const JsonError error = jsonErrorOf("Expected , or ].\n[1 2]\n   ^", "{\n\"a\": [1 2]}", "a scene");
    EXPECT_FALSE(error.isJson);
    EXPECT_EQ(error.place, ":2:9");
    EXPECT_EQ(error.reason, "is not JSON: Expected , or ].");
}

TEST(JsonErrors, RepeatedTextHasNoPlace) {
    EXPECT_EQ(jsonErrorOf("Expected :.\n{\"a\" 1}\n     ^", "[{\"a\" 1},{\"a\" 1}]", "a scene").place, "");
}

TEST(JsonErrors, FieldsHaveTheirNamesInJson) {
    const JsonError error = jsonErrorOf("(camera) field_of: Cannot find field.", "{}", "a scene");
    EXPECT_TRUE(error.isJson);
    EXPECT_EQ(error.place, "camera.fieldOf");
    EXPECT_EQ(error.reason, "is not a field of a scene");
}

}  // namespace
}  // namespace spherule
