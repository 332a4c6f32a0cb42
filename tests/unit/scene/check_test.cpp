#include "scene/check.h"

#include <gtest/gtest.h>

#include "scene/structure.h"

namespace spherule::scene {
namespace {

// Returns the paths of the errors.
std::vector<std::string> pathsOf(const Check& check) {
    std::vector<std::string> paths;
    for (const Error& error : check.errors()) paths.push_back(error.where);
    return paths;
}

using Paths = std::vector<std::string>;

TEST(Check, KeepsTheFirstErrorOfEachPart) {
    Check check(nullptr, Check::Keep::All);
    EXPECT_FALSE(check.part([&] {
        check.refuse("a", "is wrong");
        EXPECT_FALSE(check.ok());
        check.refuse("a.b", "follows from it");
    }));
    EXPECT_TRUE(check.part([&] { EXPECT_TRUE(check.ok()) << "errors of other parts do not count"; }));
    EXPECT_FALSE(check.part([&] { check.refuse("c", "is wrong"); }));
    EXPECT_FALSE(check.ok());
    check.refuse("d", "is outside of parts, after an error");
    EXPECT_EQ(pathsOf(check), (Paths{"a", "c"}));
}

TEST(Check, PartsNest) {
    Check check(nullptr, Check::Keep::All);
    check.part([&] {
        check.part([&] { check.refuse("a.x", "is wrong"); });
        check.part([&] { check.refuse("a.y", "is wrong"); });
        EXPECT_FALSE(check.ok()) << "an inner part failed";
        check.refuse("a", "follows from it");
    });
    check.part([&] {
        check.refuse("b", "is wrong");
        check.part([&] { EXPECT_TRUE(check.ok()); });
        EXPECT_FALSE(check.ok()) << "a right part within does not hide the error";
    });
    EXPECT_EQ(pathsOf(check), (Paths{"a.x", "a.y", "b"}));
}

TEST(Check, NumbersAreParts) {
    Check check(nullptr, Check::Keep::All);
    EXPECT_EQ(check.within(3, 0, 2, "a"), 2);
    EXPECT_EQ(check.upTo(-1, 2, "b", ""), -1);
    EXPECT_EQ(check.upTo(3, 2, "c", ""), 2);
    Numbers numbers;
    check.vector(numbers, "d");
    check.colour("red", "e");
    EXPECT_EQ(pathsOf(check), (Paths{"a", "b", "c", "d", "e"}));
}

TEST(Check, KeepsOnlyTheFirstErrorByDefault) {
    Check check;
    check.part([&] { check.refuse("a", "is wrong"); });
    bool read = false;
    EXPECT_FALSE(check.part([&] { read = true; }));
    check.entries("list", 3, [&](std::size_t, const std::string&) { read = true; });
    EXPECT_FALSE(read);
    EXPECT_EQ(pathsOf(check), Paths{"a"});
}

TEST(Check, EntriesHaveTheirPath) {
    Check check(nullptr, Check::Keep::All);
    check.entries("list", 3, [&](std::size_t k, const std::string& field) {
        if (k != 1) check.refuse(field, "is wrong");
    });
    EXPECT_EQ(pathsOf(check), (Paths{"list[0]", "list[2]"}));
}

TEST(Check, NothingIsReadAfterACancellation) {
    Progress progress;
    Check check(&progress, Check::Keep::All);
    check.part([&] { check.refuse("a", "is wrong"); });
    progress.cancel();
    check.part([&] { EXPECT_FALSE(check.goesOn("working", 1, 2)); });
    EXPECT_FALSE(check.part([] { FAIL() << "is read"; }));
    ASSERT_EQ(check.errors().size(), 2U);
    EXPECT_EQ(check.errors()[1].kind, ErrorKind::Cancelled);
}

TEST(Check, NothingIsReadAfterManyErrors) {
    Check check(nullptr, Check::Keep::All);
    std::size_t read = 0;
    check.entries("list", 10 * mostMistakes, [&](std::size_t, const std::string& field) {
        ++read;
        check.refuse(field, "is wrong");
    });
    EXPECT_EQ(check.errors().size(), mostMistakes);
    EXPECT_EQ(read, mostMistakes);
}

TEST(Check, TheSameErrorIsKeptOnce) {
    Check check(nullptr, Check::Keep::All);
    for (int k = 0; k < 3; ++k) check.part([&] { check.refuse("radius", "is missing"); });
    EXPECT_EQ(pathsOf(check), Paths{"radius"});
    EXPECT_FALSE(check.ok());
}

TEST(Check, ErrorsThatFollowFromDoubtsAreNotKept) {
    Check check(nullptr, Check::Keep::All);
    check.doubt("groups[1].radius");
    for (const char* path : {"groups[1].radius", "groups[1].radius.constant", "groups[1]", "groups"})
        EXPECT_FALSE(check.part([&] { check.refuse(path, "is wrong"); })) << path;
    EXPECT_EQ(pathsOf(check), Paths{});
    EXPECT_FALSE(check.ok());
    for (const char* path : {"groups[1].radiu", "groups[12]", "groups[1].radius2", "group"})
        check.part([&] { check.refuse(path, "is wrong"); });
    EXPECT_EQ(check.errors().size(), 4U);
}

TEST(Check, TellsWhatIsRight) {
    Check check(nullptr, Check::Keep::All);
    EXPECT_TRUE(check.isRight());
    check.doubt("bounds.material");
    EXPECT_FALSE(check.isRight());
    EXPECT_TRUE(check.isRight("bounds.min"));
    EXPECT_FALSE(check.isRight("bounds"));
    check.part([&] { check.refuse("bounds.min[1]", "is wrong"); });
    EXPECT_FALSE(check.isRight("bounds.min"));
    EXPECT_TRUE(check.isRight("bounds.max"));
}

}  // namespace
}  // namespace spherule::scene
