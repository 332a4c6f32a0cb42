// Meshes and height fields: their files and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include <glm/geometric.hpp>

#include "mesh_triangles.h"
#include "scene/mesh/mesh.h"
#include "scene/shapes.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

// A tetrahedron with a corner in the origin, as OBJ.
constexpr std::string_view corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
constexpr std::string_view faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

std::string tetrahedron() {
    return std::string(corners) + std::string(faces);
}

class SceneMesh : public ::testing::Test {
  protected:
    Result<Scene> loaded(const std::string& name, const std::string& bytes, const std::string& more = "",
                         const std::string& kind = "mesh") {
        (void)folder_.write(name, bytes);
        return load(folder_.write("scene.json", R"({"bounds": {"min": [0,0,0], "max": [2,2,2]}, "obstacles": [{")" +
                                                    kind + R"(": {"file": ")" + name + "\"" + more + "}}]}"),
                    "software");
    }

    std::shared_ptr<const Mesh> meshOf(const std::string& name, const std::string& bytes,
                                       const std::string& more = "") {
        const auto scene = loaded(name, bytes, more);
        EXPECT_TRUE(scene) << scene.error().text();
        return scene ? scene->obstacles.at(0).shape->mesh() : nullptr;
    }

    // Returns the refusal from the name of the file on.
    std::string refusal(const std::string& name, const std::string& bytes, const std::string& more = "",
                        const std::string& kind = "mesh") {
        const auto scene = loaded(name, bytes, more, kind);
        if (scene) return "accepted";
        EXPECT_EQ(scene.error().kind, ErrorKind::Input);
        const std::string text = scene.error().text();
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        return text.substr(std::min(text.size(), text.rfind(name)));
    }

    support::TemporaryFolder folder_;
};

std::string textStl(const std::string& vertex) {
    return "solid a b\n facet normal 0 0 nan\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex " + vertex +
           "\n  endloop\n endfacet\nendsolid a b\n";
}

TEST_F(SceneMesh, IsReadFromEachFormat) {
    EXPECT_EQ(meshOf("a.obj", tetrahedron(), R"(, "solid": true)")->corners.size(), 4U);
    EXPECT_EQ(meshOf("a.stl", textStl("0 1 0"))->corners.size(), 1U);
    const auto box = support::boxOf({0, 0, 0}, {1, 1, 1});
    std::string binary = support::stlOf(box);
    EXPECT_EQ(meshOf("b.stl", binary, R"(, "solid": true)")->corners.size(), 12U);
    binary.replace(0, 5, "solid");
    EXPECT_EQ(meshOf("b.stl", binary, R"(, "solid": true)")->corners.size(), 12U) << "binary, in spite of its header";
    EXPECT_EQ(
        meshOf("q.obj", "v 0 0 0\nv 1 0 0\r\nv 1 1 0\nv 0 1 0\ng x\nf 1/1/1 2//1 -2 -1 # square\n")->corners.size(),
        2U);
}

TEST_F(SceneMesh, CutsConcavePolygonsWithinTheirBorder) {
    // An L of three unit squares. The first corner is next to the concave one.
    const auto mesh = meshOf("l.obj", "v 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4 5 6\n");
    ASSERT_EQ(mesh->corners.size(), 4U);
    double area = 0;
    for (std::uint32_t t = 0; t < 4; ++t)
        area +=
            glm::length(glm::cross(mesh->corner(t, 1) - mesh->corner(t, 0), mesh->corner(t, 2) - mesh->corner(t, 0))) /
            2;
    EXPECT_NEAR(area, 3, 1e-12);
    EXPECT_EQ(mesh->patches.size(), 1U);
}

TEST_F(SceneMesh, HasTheSignedDistanceOfASolid) {
    const auto scene = loaded("a.obj", tetrahedron(), R"(, "solid": true, "scale": 0.5)");
    ASSERT_TRUE(scene) << scene.error().text();
    const Shape& solid = *scene->obstacles.at(0).shape;
    EXPECT_NEAR(solid.distance({0.1, 0.1, -0.3}), 0.3, 1e-12);
    EXPECT_NEAR(solid.distance({0.1, 0.05, 0.2}), -0.05, 1e-12);
    EXPECT_NEAR(solid.distance({-0.3, 0.2, -0.4}), 0.5, 1e-12) << "from an edge";
    EXPECT_NEAR(solid.distance({0, 0, 0.9}), 0.4, 1e-12) << "from a vertex";
    const auto hollow = loaded("a.obj", tetrahedron(), R"(, "hollow": true)");
    ASSERT_TRUE(hollow) << hollow.error().text();
    EXPECT_NEAR(hollow->obstacles.at(0).shape->distance({0.2, 0.1, 0.2}), 0.1, 1e-12);
    const auto sheet = loaded("a.obj", tetrahedron());
    EXPECT_NEAR(sheet->obstacles.at(0).shape->distance({0.2, 0.1, 0.2}), 0.1, 1e-12);
}

TEST_F(SceneMesh, JoinsVerticesAndDropsTriangles) {
    const auto mesh = meshOf("a.obj", std::string(corners) + "v 1 1 0\nv 1 0 1e-7\nv 0.5 0 0\n" +
                                          "f 1 2 3\nf 6 5 3\nf 3 2 1\nf 1 1 2\nf 1 7 2\n");
    EXPECT_EQ(mesh->report.moved, 1U);
    EXPECT_EQ(mesh->report.duplicated, 1U);
    EXPECT_EQ(mesh->report.collapsed, 1U);
    EXPECT_EQ(mesh->report.needles, 1U);
    EXPECT_EQ(mesh->patches.size(), 1U);
    EXPECT_EQ(mesh->report.text(),
              "1 vertices joined with one nearby, 1 triangles without an area dropped, 1 duplicated triangles dropped, "
              "1 needle triangles flattened, of 5 triangles");
}

TEST_F(SceneMesh, ThatIsNotClosedIsNoSolid) {
    EXPECT_EQ(
        refusal("a.obj", std::string(corners) + "f 1 3 2\nf 1 2 4\nf 2 3 4\n", R"(, "solid": true)"),
        "a.obj: is not closed: 3 edges have one triangle only, the first from (0, 0, 0) to (0, 1, 0); close it, or "
        "leave `solid` and `hollow` out for a thin sheet");
    EXPECT_NE(refusal("a.obj", std::string(corners) + "v 0.5 0 0\nf 1 3 5\nf 5 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
                      R"(, "solid": true)")
                  .find("at 1 of them vertices of others lie between the ends"),
              std::string::npos);
    EXPECT_EQ(
        refusal("a.obj", std::string(corners) + "f 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", R"(, "solid": true)"),
        "a.obj: has neighbours that face opposite ways at 3 edges, the first from (0, 1, 0) to (0, 0, 0); turn all "
        "normals outward");
    EXPECT_EQ(refusal("a.obj", std::string(corners) + "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n", R"(, "solid": true)"),
              "a.obj: encloses a volume of -0.167 m³, because its normals point inward; turn them outward");
}

TEST_F(SceneMesh, InOtherUnitsIsRefused) {
    EXPECT_EQ(
        refusal("a.obj", "v 0 0 0\nv 2000 0 0\nv 0 2 0\nf 1 2 3\n"),
        "a.obj: is 2000 m long, more than 100 times the bounds of 2 m; if the file is in millimetres, set `scale` to "
        "0.001");
    EXPECT_EQ(
        refusal("a.obj", tetrahedron(), R"(, "scale": 0.0001)"),
        "a.obj: is 0.0001 m long, less than 0.0001 of the bounds of 2 m; set `scale` to the metres per unit of the "
        "file");
}

TEST_F(SceneMesh, ErrorsHaveThePlaceInTheFile) {
    EXPECT_EQ(refusal("a.stl", textStl("0 1 nan")),
              "a.stl, line 6: a coordinate is \"nan\", must be a number of at most 1e+09");
    EXPECT_EQ(refusal("a.stl", textStl("0 1 1e10")),
              "a.stl, line 6: a coordinate is \"1e10\", must be a number of at most 1e+09");
    EXPECT_EQ(refusal("a.stl", textStl("0 1")),
              "a.stl, line 7: a coordinate is \"endloop\", must be a number of at most 1e+09");
    EXPECT_EQ(refusal("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\n"),
              "a.stl, line 3: the file ends, must have vertex here");
    EXPECT_EQ(refusal("a.stl", "solid x\nfacette\n"), "a.stl, line 2: is \"facette\", must be facet or endsolid");
    EXPECT_EQ(refusal("a.obj", std::string(corners) + "f 1 2 9\n"),
              "a.obj, line 5: a corner is \"9\", must be the number of one of the 4 vertices above");
    EXPECT_EQ(refusal("a.obj", std::string(corners) + "f 1 2\n"),
              "a.obj, line 5: the face has 2 corners, must have three");
    EXPECT_EQ(refusal("a.obj", "v 1 2\n"), "a.obj, line 1: a coordinate is missing, must be three");
    EXPECT_EQ(refusal("a.obj", "<html>\n"),
              "a.obj, line 1: is no statement of OBJ: \"<html>\"; the file must be STL or OBJ");
    EXPECT_EQ(refusal("a.obj", ""), "a.obj: has no triangles");
    EXPECT_EQ(refusal("a.obj", "v 1 1 1\nf 1 1 1\n"), "a.obj: has no triangle with an area");
}

TEST_F(SceneMesh, BinaryStlHasTheLengthOfItsTriangles) {
    std::string file = support::stlOf(support::boxOf({0, 0, 0}, {1, 1, 1}));
    EXPECT_EQ(refusal("a.stl", file.substr(0, file.size() - 1)),
              "a.stl: as a binary STL of 12 triangles it must have 684 bytes, but it has 683; write it again");
    std::string many = file;
    many.replace(80, 4, std::string("\x00\xca\x9a\x3b", 4));
    EXPECT_EQ(refusal("a.stl", many),
              "a.stl: as a binary STL of 1000000000 triangles it must have 50000000084 bytes, but it has 684; write it "
              "again");
    file.replace(84 + 12, 4, std::string("\x00\x00\xc0\x7f", 4));
    EXPECT_EQ(refusal("a.stl", file),
              "a.stl, triangle 1 of 12: a coordinate is nan, must be a number of at most 1e+09");
}

TEST_F(SceneMesh, IsRefusedWithoutItsFile) {
    const std::string both = loaded("no.stl", "", R"(, "data": "AAAA")", "mesh").error().text();
    EXPECT_NE(both.find("obstacles[0].mesh.data: is given with `file`; leave one of them out"), std::string::npos)
        << both;
    EXPECT_EQ(refusalOf(R"("obstacles": [{"mesh": {"file": "a.stl"}}])"),
              "obstacles[0].mesh.file: names the file \"a.stl\", but only a scene file may name files");
    EXPECT_EQ(refusalOf(R"("obstacles": [{"mesh": {"solid": true}}])"),
              "obstacles[0].mesh.file: is missing; name an STL or OBJ file, or give its bytes as `data`");
    EXPECT_EQ(refusalOf(R"("obstacles": [{"mesh": {"data": "dg=="}}])"),
              "obstacles[0].mesh.data: line 1: a coordinate is missing, must be three");
    EXPECT_EQ(refusalOf(R"("obstacles": [{"mesh": {"data": "dg==", "solid": true, "hollow": true}}])"),
              "obstacles[0].mesh.hollow: is true with `solid`; leave one of them out");
}

// A scene that is written has what it was read from.
TEST_F(SceneMesh, IsWrittenWithItsBytes) {
    const auto scene = loaded("a.obj", tetrahedron(), R"(, "solid": true, "scale": 0.5)");
    ASSERT_TRUE(scene) << scene.error().text();
    v1::Obstacle message;
    scene->obstacles.at(0).shape->write(message);
    EXPECT_EQ(message.mesh().file(), "");
    EXPECT_EQ(message.mesh().data(), tetrahedron());
    EXPECT_EQ(message.mesh().scale(), 0.5);
    EXPECT_TRUE(message.mesh().solid());
    const auto longer = loaded("long.obj", tetrahedron() + "#" + std::string(longestInlineMesh, 'x') + "\n");
    ASSERT_TRUE(longer) << longer.error().text();
    longer->obstacles.at(0).shape->write(message);
    EXPECT_EQ(message.mesh().data(), "");
    EXPECT_TRUE(message.mesh().file().starts_with('/')) << message.mesh().file();
}

// Small errors of the corners, as in float32, keep a plane one patch. A bend does not.
TEST(MeshPatches, AreTrianglesInOnePlane) {
    Check check;
    scene::Triangles sheet = support::randomSheet({0, 0}, {10, 1}, 40, 10, 3);
    for (auto& v : sheet.vertices) v = glm::dvec3(glm::vec3(v.x, 0.8 * v.y, 0.6 * v.y));
    const auto flat = Mesh::make(check, {}, sheet, {});
    ASSERT_TRUE(flat);
    EXPECT_EQ(flat->patches.size(), 1U);
    EXPECT_NEAR(glm::distance(glm::abs(flat->patches[0].normal), glm::dvec3(0, 0.6, 0.8)), 0, 1e-7);
    for (auto& v : sheet.vertices) v.z += std::max(0.0, v.x - 5) * std::tan(0.02 / 57.3);
    EXPECT_GT(Mesh::make(check, {}, sheet, {})->patches.size(), 1U);
}

TEST(MeshPatches, OfASmoothCylinderAreOneGroup) {
    Check check;
    const auto drum =
        Mesh::make(check, {}, support::lathe({{0, -1}, {1, -1}, {1, 1}, {0, 1}}, 64), {.form = Mesh::Form::Hollow});
    ASSERT_TRUE(drum) << check.error().value().message;
    EXPECT_EQ(drum->patches.size(), 66U);
    std::set<std::uint32_t> groups(drum->smoothOf.begin(), drum->smoothOf.end());
    EXPECT_EQ(groups.size(), 3U);
    for (const Mesh::Edge& edge : drum->edges) EXPECT_FALSE(edge.meets) << "a hollow has concave edges alone";
}

TEST_F(SceneMesh, HeightFieldsAreGround) {
    const std::string box = R"(, "min": [0, 0, 0], "max": [2, 1, 0.5], "depth": 0.25)";
    const auto scene = loaded("h.csv", "0, 0.5, 0\n0;0.5;0\n", box, "heightField");
    ASSERT_TRUE(scene) << scene.error().text();
    const Shape& ground = *scene->obstacles.at(0).shape;
    EXPECT_NEAR(ground.distance({1, 0.5, 0.7}), 0.2, 1e-12) << "above the ridge";
    EXPECT_NEAR(ground.distance({0.5, 0.5, 0.25}), 0, 1e-12) << "on the slope";
    EXPECT_NEAR(ground.distance({1, 0.5, -0.15}), -0.1, 1e-12) << "in the ground";
    EXPECT_NEAR(ground.distance({1, 0.5, -0.35}), 0.1, 1e-12) << "below it";
    v1::Obstacle message;
    ground.write(message);
    EXPECT_EQ(message.height_field().heights_size(), 6);
    EXPECT_EQ(message.height_field().columns(), 3U);
    EXPECT_EQ(refusal("h.csv", "0,0\n0,x\n", box, "heightField"),
              "h.csv, line 2: a coordinate is \"x\", must be a number of at most 1e+09");
    EXPECT_EQ(refusal("h.csv", "0,0\n0\n", box, "heightField"),
              "h.csv, line 2: has 1 heights, must have 2 as the first line");
    EXPECT_EQ(refusal("h.csv", "0,0\n", box, "heightField"), "h.csv: has 2 by 1 heights, must have at least 2 by 2");
    const auto high = loaded("h.csv", "0,0\n0,0.6\n", box, "heightField");
    EXPECT_NE(
        high.error().text().find("has the height 0.6 m in row 2, column 2, must be between min z = 0 and max z = 0.5"),
        std::string::npos)
        << high.error().text();
    EXPECT_EQ(refusal("h.png", "\x89PNG\r\n\x1a\nabc", box, "heightField"),
              "h.png: cannot be read as PNG: the file ends too early");
}

// Two by two pixels of 16 bits: black and white, and below them half grey and black.
TEST_F(SceneMesh, HeightFieldsAreReadFromPng) {
    constexpr unsigned char png[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49,
                                     0x48, 0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00,
                                     0x00, 0x00, 0x00, 0x07, 0x4d, 0x8e, 0xbb, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44,
                                     0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x60, 0xf8, 0xff, 0x9f, 0xa1, 0x81, 0x81,
                                     0x81, 0x01, 0x00, 0x0e, 0xfd, 0x02, 0x7f, 0x2b, 0x03, 0x8e, 0xd0, 0x00, 0x00,
                                     0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    const auto scene = loaded("h.png", std::string(std::begin(png), std::end(png)),
                              R"(, "min": [0, 0, 0], "max": [2, 2, 1])", "heightField");
    ASSERT_TRUE(scene) << scene.error().text();
    v1::Obstacle message;
    scene->obstacles.at(0).shape->write(message);
    const auto& heights = message.height_field().heights();
    ASSERT_EQ(heights.size(), 4);
    EXPECT_NEAR(heights[0], 32768.0 / 65535, 1e-12) << "the lowest row of pixels has the smallest y";
    EXPECT_EQ(heights[1], 0);
    EXPECT_EQ(heights[2], 0);
    EXPECT_EQ(heights[3], 1);
}

}  // namespace
}  // namespace spherule::scene::testing
