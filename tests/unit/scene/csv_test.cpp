#include <gtest/gtest.h>
#include <sys/stat.h>

#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

class SceneCsv : public ::testing::Test {
  protected:
    Result<Scene> loaded(const std::string& csv, const std::string& more = "") {
        (void)folder_.write("balls.csv", csv);
        return load(folder_.write("scene.json", R"({"bounds": {"min": [0,0,0], "max": [1,1,1]}, "groups": [
            {"csv": {"file": "balls.csv"})" + more + "}]}"),
                    "software");
    }

    // Returns the part of the refusal that starts with the name of the CSV file.
    std::string refusal(const std::string& csv, const std::string& more = "") {
        const auto scene = loaded(csv, more);
        if (scene) return "accepted";
        EXPECT_NE(scene.error().where.find("scene.json:2:30: groups[0].csv.file"), std::string::npos)
            << scene.error().where;
        const std::string& text = scene.error().message;
        return text.substr(std::min(text.size(), text.find("balls.csv:")));
    }

    TemporaryFolder folder_;
};

constexpr const char* radius = R"(, "radius": {"constant": 0.1}, "velocity": [0, 0, 2], "spin": [3, 0, 0])";

TEST_F(SceneCsv, DefinesPositions) {
    const auto scene = loaded("x,y,z\n0.2,0.3,0.4\n0.5, 6e-1 ,0.5\r\n", radius);
    ASSERT_TRUE(scene) << scene.error().text();
    ASSERT_EQ(scene->spheres.size(), 2U);
    EXPECT_EQ(scene->spheres[0].position, glm::dvec3(0.2, 0.3, 0.4));
    EXPECT_EQ(scene->spheres[1].position, glm::dvec3(0.5, 0.6, 0.5));
    EXPECT_EQ(scene->spheres[1].velocity, glm::vec3(0, 0, 2));
    EXPECT_EQ(scene->spheres[1].spin, glm::vec3(3, 0, 0));
    EXPECT_EQ(scene->spheres[1].radius, 0.1F);
}

TEST_F(SceneCsv, DefinesVelocitiesAndRadii) {
    const auto scene = loaded("x,y,z,vx,vy,vz,radius\n0.2,0.3,0.4,1,2,3,0.05", radius);
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->spheres.at(0).velocity, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene->spheres[0].radius, 0.05F);
    const auto noVelocity = loaded("x,y,z,radius\n0.2,0.3,0.4,0.05");
    ASSERT_TRUE(noVelocity) << noVelocity.error().text();
    EXPECT_EQ(noVelocity->spheres.at(0).radius, 0.05F);
}

TEST_F(SceneCsv, MayHaveNoSpheres) {
    EXPECT_TRUE(loaded("x,y,z,radius\n"));
}

TEST_F(SceneCsv, ErrorsHaveLineAndColumn) {
    EXPECT_EQ(refusal("x,y,z,radius\n0.2,0.3,0.4,0.1\n0.2,abc,0.4,0.1\n"),
              "balls.csv:3:5: y is \"abc\", must be a number");
    EXPECT_EQ(refusal("x,y,z,radius\n0.2,0.3,nan,0.1\n"), "balls.csv:2:9: z is nan, must be a finite number");
    EXPECT_EQ(refusal("x,y,z,radius\n0.2,0.3,0.4,0\n"), "balls.csv:2:13: radius is 0, must be positive");
    EXPECT_EQ(refusal("x,y,z,radius\n0.2,0.3,0.4\n"),
              "balls.csv:2:12: the line must have 4 numbers, as the header has names");
    EXPECT_EQ(refusal("x,y,z\n0.2,0.3,0.4,5\n", radius),
              "balls.csv:2:13: the line must have 3 numbers, as the header has names");
    EXPECT_EQ(refusal("x,y,z\n0.2,,0.4\n", radius), "balls.csv:2:5: y is \"\", must be a number");
    EXPECT_EQ(refusal("x,y,z\n1e999,0,0\n", radius),
              "balls.csv:2:1: x is \"1e999\", which is too large; must be -1.7e308 to 1.7e308");
    for (const std::string word : {"+-1", "++1", "+", "1e", "1e999x"})
        EXPECT_EQ(refusal("x,y,z\n" + word + ",0,0\n", radius),
                  "balls.csv:2:1: x is \"" + word + "\", must be a number");
    EXPECT_EQ(refusal("x,y,z\n0,+2e308,0\n", radius),
              "balls.csv:2:3: y is \"+2e308\", which is too large; must be -1.7e308 to 1.7e308");
}

TEST_F(SceneCsv, NumbersMayHaveAPlusSignOrBeTiny) {
    const auto scene = loaded("x,y,z,vx,vy,vz\n+0.2,+3e-1,0.4,1e-330,-1e-999,+1e+1\n", radius);
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->spheres.at(0).position, glm::dvec3(0.2, 0.3, 0.4));
    EXPECT_EQ(scene->spheres[0].velocity, glm::vec3(0, 0, 10));
}

TEST_F(SceneCsv, ErrorHasTheLineOfASphereOutsideTheBounds) {
    EXPECT_EQ(refusal("x,y,z,radius\n0.5,0.5,0.5,0.1\n0.5,0.5,3,0.1\n"),
              "balls.csv:3:1: the sphere at (0.5, 0.5, 3) with radius 0.1 reaches z = 3.1, outside the bounds, which "
              "are 0 to 1");
}

TEST_F(SceneCsv, NeedsAKnownHeader) {
    EXPECT_EQ(refusal("a,b,c\n"), "balls.csv:1:1: the header is \"a,b,c\", must be x,y,z[,vx,vy,vz][,radius]");
    EXPECT_EQ(refusal(""), "balls.csv:1:1: the header is \"\", must be x,y,z[,vx,vy,vz][,radius]");
}

TEST_F(SceneCsv, NeedsARadius) {
    const auto scene = loaded("x,y,z\n0.5,0.5,0.5\n");
    ASSERT_FALSE(scene);
    EXPECT_TRUE(scene.error().where.ends_with("scene.json:2:13: groups[0].radius")) << scene.error().where;
}

TEST_F(SceneCsv, MustExist) {
    const auto scene = load(folder_.write("scene.json", R"({"bounds": {"min": [0,0,0], "max": [1,1,1]}, "groups": [
        {"csv": {"file": "none.csv"}}]})"),
                            "software");
    ASSERT_FALSE(scene);
    EXPECT_TRUE(scene.error().text().ends_with("none.csv: there is no such file")) << scene.error().text();
}

TEST_F(SceneCsv, MayStartWithAByteOrderMark) {
    const auto scene = loaded("\xef\xbb\xbfx,y,z\n0.2,0.3,0.4\n", radius);
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->spheres.size(), 1U);
    EXPECT_EQ(refusal("\xef\xbb\xbfx,y,u\n"),
              "balls.csv:1:1: the header is \"x,y,u\", must be x,y,z[,vx,vy,vz][,radius]");
}

TEST_F(SceneCsv, TooLongLineIsAnError) {
    EXPECT_EQ(refusal("x,y,z\n0.2,0.3,0.4\n" + std::string(100'000, ' ') + "0.5,0.5,0.5\n", radius),
              "balls.csv:3: the line is longer than 4096 bytes");
}

TEST_F(SceneCsv, ReadErrorIsNotEndOfFile) {
    const auto scene = load(folder_.write("scene.json", R"({"bounds": {"min": [0,0,0], "max": [1,1,1]}, "groups": [
        {"csv": {"file": "/proc/self/mem"}}]})"),
                            "software");
    ASSERT_FALSE(scene);
    EXPECT_TRUE(scene.error().message.ends_with("/proc/self/mem:1: cannot be read: Input/output error"))
        << scene.error().text();
}

TEST_F(SceneCsv, MustBeARegularFile) {
    const std::string pipe = folder_ / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    for (const auto& [file, kind] :
         {std::pair<std::string, std::string>(pipe, "a pipe"), {"/dev/zero", "a device"}, {"/tmp", "a folder"}}) {
        const auto scene = load(folder_.write("scene.json", R"({"bounds": {"min": [0,0,0], "max": [1,1,1]}, "groups": [
            {"csv": {"file": ")" + file + R"("}}]})"),
                                "software");
        ASSERT_FALSE(scene);
        EXPECT_EQ(scene.error().message, file + ": is " + kind + ", must be a regular file");
    }
}

}  // namespace
}  // namespace spherule::scene::testing
