#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include "sphere_file.h"

namespace spherule::scene::testing {
namespace {

const SphereFile file("xyz", "balls.xyz");
constexpr const char* group = R"(, "radius": {"constant": 2}, "velocity": [0, 0, 2], "spin": [3, 0, 0])";

TEST(SceneXyz, PlainFileHasPositions) {
    const auto spheres = file.spheres("2\nany comment, \"Properties=no\"\nX 1 2 3\nO\t-4  5e0 .5 \r\n", "", group);
    ASSERT_EQ(spheres.size(), 2U);
    EXPECT_EQ(spheres[0].position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(spheres[1].position, glm::dvec3(-4, 5, 0.5));
    EXPECT_EQ(spheres[1].velocity, glm::vec3(0, 0, 2));
    EXPECT_EQ(spheres[1].spin, glm::vec3(3, 0, 0));
    EXPECT_EQ(spheres[1].radius, 2);
}

TEST(SceneXyz, PropertiesHaveAnyOrder) {
    const auto spheres = file.spheres(
        "1\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=id:I:1:radii:R:1:velo:R:3:tags:L:2:"
        "pos:R:3:species:S:1:omega:R:3 pbc=\"F F F\"\n"
        "7 5.5 1 2 3 T F 4 5 6 Si 7 8 9\n");
    ASSERT_EQ(spheres.size(), 1U);
    EXPECT_EQ(spheres[0].radius, 5.5F);
    EXPECT_EQ(spheres[0].velocity, glm::vec3(1, 2, 3));
    EXPECT_EQ(spheres[0].position, glm::dvec3(4, 5, 6));
    EXPECT_EQ(spheres[0].spin, glm::vec3(7, 8, 9));
}

TEST(SceneXyz, PropertiesInQuotedTextAreNoProperties) {
    const std::string rest = " b\" Properties=radius:R:1:pos:R:3\n5 1 2 3\n";
    for (const std::string note : {"note=\"a Properties=pos:R:3", "note=\"a \\\" Properties=pos:R:3"}) {
        const auto spheres = file.spheres("1\n" + note + rest);
        ASSERT_EQ(spheres.size(), 1U) << note;
        EXPECT_EQ(spheres[0].radius, 5) << note;
        EXPECT_EQ(spheres[0].position, glm::dvec3(1, 2, 3)) << note;
    }
}

TEST(SceneXyz, ScaleConvertsLengths) {
    const auto spheres =
        file.spheres("1\nProperties=pos:R:3:radius:R:1:vel:R:3:angular_velocity:R:3\n1 2 3 5500 4 5 6 7 8 9\n",
                     R"(, "scale": 0.001)");
    ASSERT_EQ(spheres.size(), 1U);
    EXPECT_EQ(spheres[0].position, glm::dvec3(0.001, 0.002, 0.003));
    EXPECT_EQ(spheres[0].radius, 5.5F);
    EXPECT_EQ(spheres[0].velocity, glm::vec3(0.004F, 0.005F, 0.006F));
    EXPECT_EQ(spheres[0].spin, glm::vec3(7, 8, 9));
    EXPECT_EQ(file.refusal("0\n\n", R"(, "scale": -1)", group),
              "groups[0].xyz.scale: is -1, must be above 0 m per unit of length of the file");
}

TEST(SceneXyz, FrameIsChosen) {
    const std::string text = "1\n\nX 1 1 1\n2\nProperties=species:S:1:pos:R:3\nX 2 2 2\nX 3 3 3\n0\n\n";
    EXPECT_EQ(file.spheres(text, "", group).at(0).position.x, 1);
    EXPECT_EQ(file.spheres(text, R"(, "frame": 1)", group).at(1).position.x, 3);
    EXPECT_EQ(file.spheres(text, R"(, "frame": 2)", group).size(), 0U);
    EXPECT_EQ(file.refusal(text, R"(, "frame": 3)", group),
              "balls.xyz:10:1: the file ends before frame 3; the first is 0");
    EXPECT_EQ(file.refusal("3\n\nX 1 1 1\n", R"(, "frame": 1)", group),
              "balls.xyz:4:1: the file ends after 1 of 3 atoms of frame 0");
}

TEST(SceneXyz, BlankLinesMayBeBetweenFrames) {
    const std::string text = "1\n\nX 1 1 1\n\n \t\n1\n\nX 2 2 2\n\n";
    EXPECT_EQ(file.spheres(text, R"(, "frame": 1)", group).at(0).position.x, 2);
    EXPECT_EQ(file.refusal(text, R"(, "frame": 2)", group),
              "balls.xyz:10:1: the file ends before frame 2; the first is 0");
}

// Random spheres, written with random names and orders of the columns, are read back.
TEST(SceneXyz, ReadsWhatIsWritten) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Random random(seed);
        auto spheres = randomSpheres(random);
        const bool spin = random.uniform() < 0.5;
        const bool radiusFirst = random.uniform() < 0.5;
        std::string text =
            fmt::format("{}\nProperties={}pos:R:3:velocities:R:3{}{}\n", spheres.size(),
                        radiusFirst ? "radius:R:1:" : "", spin ? ":omega:R:3" : "", radiusFirst ? "" : ":radii:R:1");
        for (Sphere& s : spheres) {
            if (!spin) s.spin = {};
            const std::string radius = fmt::format("{:.9g}", s.radius);
            text += fmt::format("{} {:.17g} {:.17g} {:.17g} {:.9g} {:.9g} {:.9g}", radiusFirst ? radius : "",
                                s.position.x, s.position.y, s.position.z, s.velocity.x, s.velocity.y, s.velocity.z);
            if (spin) text += fmt::format(" {:.9g} {:.9g} {:.9g}", s.spin.x, s.spin.y, s.spin.z);
            text += (radiusFirst ? "" : " " + radius) + "\n";
        }
        expectEqual(file.spheres(text), spheres);
    }
}

TEST(SceneXyz, ErrorsHaveLineAndColumn) {
    const auto refusal = [](const std::string& text) { return file.refusal(text, "", group); };
    EXPECT_EQ(refusal(""), "balls.xyz:1:1: the file ends before frame 0; the first is 0");
    EXPECT_EQ(refusal("x,y,z\n"),
              "balls.xyz:1:1: the number of atoms is \"x,y,z\", must be a whole number of at least 0");
    EXPECT_EQ(refusal("a header\n"),
              "balls.xyz:1:1: the line is \"a header\", must be the number of atoms, as in the "
              "format XYZ");
    EXPECT_EQ(refusal("-1\n\n"), "balls.xyz:1:1: the number of atoms is \"-1\", must be a whole number of at least 0");
    EXPECT_EQ(refusal("1\n"), "balls.xyz:2:1: the file ends before the comment line");
    EXPECT_EQ(refusal("2\n\nX 1 2 3\n"), "balls.xyz:4:1: the file ends after 1 of 2 atoms");
    EXPECT_EQ(refusal("1\n\nX 1 two 3\n"), "balls.xyz:3:5: y is \"two\", must be a number");
    EXPECT_EQ(refusal("1\n\nX 1 2 inf\n"), "balls.xyz:3:7: z is inf, must be a finite number");
    EXPECT_EQ(refusal("1\n\nX 1 2\n"), "balls.xyz:3:6: the line must have 4 values: species x y z");
    EXPECT_EQ(refusal("1\n\nX 1 2 3 4\n"), "balls.xyz:3:9: the line must have 4 values: species x y z");
    EXPECT_EQ(refusal("1\nProperties=pos:R:3\n1 2\n"),
              "balls.xyz:3:4: the line must have 3 values, as Properties has columns");
    EXPECT_EQ(refusal("1\nProperties=pos:R:3:radius:R:1\n1 2 3 0\n"), "balls.xyz:3:7: radius is 0, must be positive");
    EXPECT_EQ(refusal("1\n\nX 1 2 999\n"),
              "balls.xyz:3:1: the sphere at (1, 2, 999) with radius 2 reaches z = 1001, outside the bounds, which are "
              "-1000 to 1000");
    EXPECT_EQ(refusal("99999999\n\n"),
              "groups[0].xyz.file: asks for 99999999 spheres, but a scene holds at most "
              "16000000 and has room for 16000000");
    EXPECT_EQ(refusal("1\n" + std::string(100'000, ' ')), "balls.xyz:2: the line is longer than 65536 bytes");
}

TEST(SceneXyz, PropertiesMustBeRight) {
    const auto refusal = [](const std::string& properties) {
        return file.refusal("0\nProperties=" + properties, "", group);
    };
    EXPECT_EQ(refusal("species:S:1"), "balls.xyz:2:1: Properties has no positions, must have pos:R:3");
    EXPECT_EQ(refusal("pos:R"), "balls.xyz:2:12: Properties must be a list of name:type:columns");
    EXPECT_EQ(refusal("pos:R:x"),
              "balls.xyz:2:18: the number of columns is \"x\", must be a whole number of at least 0");
    EXPECT_EQ(refusal("pos:R:2"), "balls.xyz:2:12: the property pos has 2 columns, must have 3");
    EXPECT_EQ(refusal("pos:R:3:radius:R:1:radii:R:1"),
              "balls.xyz:2:31: the property radii gives a quantity that an earlier property gives");
    EXPECT_EQ(refusal("pos:R:3:q:R:9999999"),
              "balls.xyz:2:24: Properties has too many columns, must have at most 2048");
    EXPECT_EQ(refusal("\"pos:R:3\""), "accepted");
}

TEST(SceneXyz, NeedsARadius) {
    EXPECT_EQ(file.refusal("1\n\nX 1 2 3\n"),
              "groups[0].radius: is missing; give one of constant, uniform, normal, logNormal, table");
}

TEST(SceneXyz, CanBeCancelled) {
    const TemporaryFolder folder;
    (void)folder.write("balls.xyz", "1\n\nX 1 1 1\n");
    Progress progress;
    progress.cancel();
    const auto scene = load(folder.write("scene.json", R"({"bounds": {"min": [0, 0, 0], "max": [9, 9, 9]}, "groups":
        [{"xyz": {"file": "balls.xyz"}, "radius": {"constant": 0.1}}]})"),
                            "software", {}, &progress);
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().kind, ErrorKind::Cancelled);
}

}  // namespace
}  // namespace spherule::scene::testing
