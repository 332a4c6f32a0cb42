#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <numeric>

#include "sphere_file.h"

namespace spherule::scene::testing {
namespace {

const SphereFile file("lammps", "bed.lmp");
constexpr const char* radius = R"(, "radius": {"uniform": {"min": 2, "max": 3}})";

// Numbers 0 to count - 1 in a random order.
std::vector<std::size_t> shuffled(std::size_t count, Random& random) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = 1; i < count; ++i)
        std::swap(order[i], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1))]);
    return order;
}

std::string dataHeader(std::size_t atoms, const std::string& style) {
    return fmt::format(
        "LAMMPS data file\n\n{} atoms\n1 atom types\n\n-9 9 xlo xhi\n\nMasses\n\n1 1.0\n\nAtoms # {}\n\n", atoms,
        style);
}

std::string dumpHeader(std::size_t atoms, const std::string& columns) {
    return fmt::format(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp pp ff\n-1000 1000\n-500 500\n"
        "100 300\nITEM: ATOMS {}\n",
        atoms, columns);
}

std::string dataOf(const std::vector<Sphere>& spheres, Random& random) {
    std::string text = dataHeader(spheres.size(), "sphere");
    for (const std::size_t i : shuffled(spheres.size(), random)) {
        const Sphere& s = spheres[i];
        text += fmt::format("{} 1 {:.9g} 2500 {:.17g} {:.17g} {:.17g} 0 -1 2\n", 10 * i + 1, 2 * s.radius, s.position.x,
                            s.position.y, s.position.z);
    }
    text += "\nVelocities\n\n";
    for (const std::size_t i : shuffled(spheres.size(), random)) {
        const Sphere& s = spheres[i];
        text += fmt::format("{} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", 10 * i + 1, s.velocity.x, s.velocity.y,
                            s.velocity.z, s.spin.x, s.spin.y, s.spin.z);
    }
    return text;
}

std::string dumpOf(const std::vector<Sphere>& spheres, bool scaled, bool diameter, Random& random) {
    std::string text =
        dumpHeader(spheres.size(), fmt::format("type omegax omegay omegaz id {} vx vy vz {}",
                                               scaled ? "zs ys xs" : "zu yu xu", diameter ? "diameter" : "radius"));
    for (const std::size_t i : shuffled(spheres.size(), random)) {
        const Sphere& s = spheres[i];
        const glm::dvec3 p =
            scaled ? glm::dvec3((s.position.x + 1000) / 2000, (s.position.y + 500) / 1000, (s.position.z - 100) / 200)
                   : s.position;
        text += fmt::format("1 {:.9g} {:.9g} {:.9g} {} {:.17g} {:.17g} {:.17g} {:.9g} {:.9g} {:.9g} {:.9g}\n", s.spin.x,
                            s.spin.y, s.spin.z, 10 * i + 1, p.z, p.y, p.x, s.velocity.x, s.velocity.y, s.velocity.z,
                            diameter ? 2 * s.radius : s.radius);
    }
    return text;
}

// Random spheres are read back in the order of their IDs, in any order of the lines.
TEST(SceneLammps, ReadsWhatIsWritten) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Random random(seed);
        const auto spheres = randomSpheres(random);
        expectEqual(file.spheres(dataOf(spheres, random)), spheres);
        for (const bool scaled : {false, true})
            for (const bool diameter : {false, true})
                expectEqual(file.spheres(dumpOf(spheres, scaled, diameter, random)), spheres);
    }
}

// The radii that the group draws do not depend on the order of the lines either.
TEST(SceneLammps, OrderOfLinesHasNoEffect) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        const std::size_t count = 1 + seed % 20;
        std::string sorted = dumpHeader(count, "id x y z");
        std::string mixed = sorted;
        std::string data = dataHeader(count, "atomic");
        for (std::size_t i = 0; i < count; ++i) sorted += fmt::format("{0} {0} 0 {0}\n", i);
        for (const std::size_t i : shuffled(count, random)) mixed += fmt::format("{0} {0} 0 {0}\n", i);
        for (const std::size_t i : shuffled(count, random)) data += fmt::format("{0} 1 {0} 0 {0}\n", i);
        const auto expected = file.spheres(sorted, "", radius);
        expectEqual(file.spheres(mixed, "", radius), expected);
        expectEqual(file.spheres(data, "", radius), expected);
    }
}

TEST(SceneLammps, ScaleConvertsLengths) {
    const std::string dump =
        dumpHeader(1, "id x y z radius vx vy vz omegax omegay omegaz") + "1 1 2 3 5000 4 5 6 7 8 9\n";
    const std::string data = dataHeader(1, "sphere") + "1 1 10000 2500 1 2 3\n\nVelocities\n\n1 4 5 6 7 8 9\n";
    for (const std::string& text : {dump, data}) {
        const auto spheres = file.spheres(text, R"(, "scale": 0.001)");
        ASSERT_EQ(spheres.size(), 1U);
        EXPECT_EQ(spheres[0].position, glm::dvec3(0.001, 0.002, 0.003));
        EXPECT_EQ(spheres[0].radius, 5);
        EXPECT_EQ(spheres[0].velocity, glm::vec3(0.004F, 0.005F, 0.006F));
        EXPECT_EQ(spheres[0].spin, glm::vec3(7, 8, 9));
    }
}

TEST(SceneLammps, SnapshotIsChosen) {
    const std::string text =
        dumpHeader(1, "id x y z") + "1 1 0 0\n" + dumpHeader(2, "id zs ys xs") + "4 0 0 0.5\n3 0.5 0 0.25\n";
    EXPECT_EQ(file.spheres(text, "", radius).at(0).position.x, 1);
    const auto second = file.spheres(text, R"(, "frame": 1)", radius);
    ASSERT_EQ(second.size(), 2U);
    EXPECT_EQ(second[0].position, glm::dvec3(-500, -500, 200));
    EXPECT_EQ(second[1].position, glm::dvec3(0, -500, 100));
    EXPECT_EQ(file.refusal(text, R"(, "frame": 2)", radius),
              "bed.lmp:22:1: the file ends before snapshot 2; the first is 0");
    EXPECT_EQ(file.refusal(dataHeader(0, "atomic"), R"(, "frame": 1)", radius),
              "groups[0].lammps.frame: is of no use: a LAMMPS data file has one state; leave frame out");
}

TEST(SceneLammps, GroupGivesValuesThatTheFileLacks) {
    const auto spheres = file.spheres(dataHeader(1, "atomic") + "1 1 0 0 0 1 1 1\n", "",
                                      R"(, "radius": {"constant": 2}, "velocity": [0, 0, 2], "spin": [3, 0, 0])");
    ASSERT_EQ(spheres.size(), 1U);
    EXPECT_EQ(spheres[0].radius, 2);
    EXPECT_EQ(spheres[0].velocity, glm::vec3(0, 0, 2));
    EXPECT_EQ(spheres[0].spin, glm::vec3(3, 0, 0));
    EXPECT_EQ(file.spheres(dataHeader(0, "atomic"), "", radius).size(), 0U);
}

TEST(SceneLammps, RowsMayHaveComments) {
    const std::string rows =
        "1 1 4 2500 1 2 3 # first one\n2 1 4 2500 4 5 6#\n\nVelocities # x\n\n1 1 0 0 0 0 0 # a b\n2 2 0 0 0 0 0\n";
    const auto spheres = file.spheres(dataHeader(2, "sphere") + rows);
    ASSERT_EQ(spheres.size(), 2U);
    EXPECT_EQ(spheres[0].position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(spheres[1].velocity, glm::vec3(2, 0, 0));
    const auto flags = file.spheres(dataHeader(1, "atomic") + "# id type x y z\n1 1 7 8 9 0 0 0 # c\n", "", radius);
    EXPECT_EQ(flags.at(0).position, glm::dvec3(7, 8, 9));
}

TEST(SceneLammps, ErrorsInDataFilesHaveLineAndColumn) {
    const auto refusal = [](const std::string& text) { return file.refusal(text, "", radius); };
    const std::string sphere = dataHeader(2, "sphere");
    EXPECT_EQ(refusal(""), "bed.lmp:1:1: the file is empty, must be a LAMMPS data or dump file");
    EXPECT_EQ(refusal("x,y,z\n1,2,3\n"), "bed.lmp:3:1: the file has no section Atoms, as a LAMMPS data file has");
    EXPECT_EQ(refusal("title\n2 atoms\n\nAtoms\n\n"),
              "bed.lmp:4:1: the section Atoms does not name its atom style; write \"Atoms # sphere\" or \"Atoms # "
              "atomic\"");
    for (const std::string line : {"Atoms x #", "Atoms sphere x", "Atoms #", "Atoms #  \t"})
        EXPECT_EQ(refusal("title\n2 atoms\n\n" + line + "\n\n"),
                  "bed.lmp:4:1: the section Atoms does not name its atom style; write \"Atoms # sphere\" or \"Atoms # "
                  "atomic\"");
    EXPECT_EQ(refusal(dataHeader(1, "hybrid sphere charge")),
              "bed.lmp:12:9: the atom style is \"hybrid sphere charge\", must be sphere or atomic; write the data file "
              "with one of them");
    EXPECT_EQ(refusal("title\n\nAtoms # sphere\n"),
              "bed.lmp:3:1: the number of atoms must come before the section Atoms");
    EXPECT_EQ(refusal(sphere + "1 1 2 2500 0 0 0\n"),
              "bed.lmp:15:1: the file ends after 1 of 2 lines of the section Atoms");
    EXPECT_EQ(refusal(sphere + "1 1 0 2500 0 0 0\n"), "bed.lmp:14:5: half the diameter is 0, must be positive");
    EXPECT_EQ(refusal(sphere + "1 1 2 2500 0 0\n"),
              "bed.lmp:14:15: the line must have 7 values: id type diameter "
              "density x y z, perhaps with image flags");
    EXPECT_EQ(refusal(sphere + "1 1 2 2500 0 0 0\n1 1 2 2500 9 9 9\n"),
              "bed.lmp:15:1: the id 1 is also in line 14; each sphere must have one of its own");
    EXPECT_EQ(refusal(sphere + "9 1 2 2500 0 0 0\n1 1 2 2500 0 0 9999\n"),
              "bed.lmp:15:1: the sphere at (0, 0, 9999) with radius 1 reaches z = 10000, outside the bounds, which are "
              "-1000 to 1000");
    const std::string two = sphere + "1 1 2 2500 0 0 0\n2 1 2 2500 9 9 9\n\nVelocities\n\n";
    EXPECT_EQ(refusal(two + "1 0 0 0 0 0 0\n3 0 0 0 0 0 0\n"), "bed.lmp:20:1: the id 3 is not in the section Atoms");
    EXPECT_EQ(refusal(two + "1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n"),
              "bed.lmp:20:1: the id 1 is in an earlier line of the section, too");
    EXPECT_EQ(refusal(two + "1 0 0 0\n"), "bed.lmp:19:8: the line must have 7 values: id vx vy vz wx wy wz");
}

TEST(SceneLammps, ErrorsInDumpFilesHaveLineAndColumn) {
    const auto refusal = [](const std::string& columns, const std::string& rows) {
        return file.refusal(dumpHeader(1, columns) + rows, "", radius);
    };
    EXPECT_EQ(refusal("id x y z", ""), "bed.lmp:10:1: the file ends after 0 of 1 atoms");
    EXPECT_EQ(refusal("id x y z", "1 0 nil 0\n"), "bed.lmp:10:5: y is \"nil\", must be a number");
    EXPECT_EQ(refusal("id x y z", "1.5 0 0 0\n"), "bed.lmp:10:1: id is \"1.5\", must be a whole number of at least 0");
    EXPECT_EQ(refusal("id x y z", "1 0 0\n"), "bed.lmp:10:6: the line must have 4 values, as ITEM: ATOMS has columns");
    EXPECT_EQ(refusal("x y z", "0 0 0\n"),
              "bed.lmp:9:1: the dump has no column id, which gives the order of the spheres; add id to its columns");
    EXPECT_EQ(refusal("id type", "1 1\n"),
              "bed.lmp:9:1: the dump has no positions; it must have the columns x y z, xu yu "
              "zu, xs ys zs or xsu ysu zsu");
    EXPECT_EQ(refusal("id x y z vx vz", "1 0 0 0 0 0\n"), "bed.lmp:9:1: the dump has the column vx, but not vy");
    EXPECT_EQ(
        file.refusal("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 1 0\n0 1 "
                     "0\n0 1 0\nITEM: ATOMS id xs ys zs\n1 0 0 0\n",
                     "", radius),
        "bed.lmp:9:1: xs is relative to the box, which must be orthogonal then; write x y z in its place");
}

}  // namespace
}  // namespace spherule::scene::testing
