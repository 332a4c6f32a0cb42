// Emitters as scenes describe them: what is refused, when they work, and where they make spheres.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scene/describe.h"
#include "scene/random.h"
#include "scene_support.h"

namespace spherule::scene {
namespace {

using testing::refusalOf;
using testing::sceneWith;

constexpr std::string_view ball = R"("sphere": {"centre": [0.5, 0.5, 0.5], "radius": 0.2})";
constexpr std::string_view flow = R"("rate": 100, "radius": {"constant": 0.01})";

std::string emitter(std::string_view members) {
    return R"("emitters": [{)" + std::string(members) + "}]";
}

std::string inBall(std::string_view members) {
    return emitter(std::string(ball) + ", " + std::string(members));
}

std::string with(std::string_view members) {
    return inBall(std::string(flow) + ", " + std::string(members));
}

TEST(Emitters, AreRefusedWithTheFieldAndTheReason) {
    EXPECT_EQ(refusalOf(emitter(flow)), "emitters[0]: has no region, must have one of box, sphere, cylinder, disc");
    EXPECT_EQ(refusalOf(inBall(R"("radius": {"constant": 0.01})")),
              "emitters[0]: has no flow, must have rate or massFlow");
    EXPECT_EQ(refusalOf(inBall(R"("rate": 10)")), "emitters[0].radius: is missing");
    EXPECT_EQ(refusalOf(inBall(R"("rate": 0, "radius": {"constant": 0.01})")),
              "emitters[0].rate: is 0, must be positive");
    EXPECT_EQ(refusalOf(inBall(R"("massFlow": -1, "radius": {"constant": 0.01})")),
              "emitters[0].massFlow: is -1, must be positive");
    EXPECT_EQ(refusalOf(with(R"("total": 0)")), "emitters[0].total: is 0, must be at least 1");
    EXPECT_EQ(refusalOf(with(R"("repeat": 2)")), "emitters[0].repeat: needs a schedule");
    EXPECT_EQ(refusalOf(with(R"("schedule": [{"from": 1, "to": 1}])")),
              "emitters[0].schedule[0].to: is 1 s, must be at least 1e-06 s after from, which is 1 s");
    EXPECT_EQ(refusalOf(with(R"("schedule": [{"from": 1, "to": 1.0000005}])")),
              "emitters[0].schedule[0].to: is 1.0000005 s, must be at least 1e-06 s after from, which is 1 s");
    EXPECT_EQ(refusalOf(with(R"("schedule": [{"to": 1e-300}], "repeat": 1e-300)")),
              "emitters[0].schedule[0].to: is 1e-300, must be 1e-06 to 1000000000 s");
    EXPECT_EQ(refusalOf(with(R"("schedule": [{"to": 1}], "repeat": 1e-300)")),
              "emitters[0].repeat: is 1e-300 s, must be 0 or at least 1e-06 s");
    EXPECT_EQ(refusalOf(with(R"("schedule": [{"to": 2}, {"from": 1, "to": 3}])")),
              "emitters[0].schedule[1].from: is 1 s, but the time before it ends at 2 s; give them in order");
    EXPECT_EQ(refusalOf(with(R"("schedule": [{"to": 2}], "repeat": 1)")),
              "emitters[0].repeat: is 1 s, must be at least the end of the schedule, 2 s");
    EXPECT_EQ(refusalOf(with(R"("material": "lead")")).find("emitters[0].material: "), 0U);
    EXPECT_EQ(refusalOf(with(R"("colour": "blue")")).find("emitters[0].colour: "), 0U);
    EXPECT_EQ(refusalOf(with(R"("velocity": [0, 0, 1e6])"))
                  .find("emitters[0]: makes spheres of radius 0.01 m with up to 1e+06 m/s; the scene"),
              0U);
    const std::string start = "emitters[0].";
    EXPECT_EQ(refusalOf(emitter(R"("box": {"min": [0, 0, 0], "max": [0, 0, 1]}, )" + std::string(flow))),
              start + "box: has no area: its min and max may be equal along one axis alone");
    EXPECT_EQ(refusalOf(emitter(R"("box": {"min": [0, 0, 0.5], "max": [1, 1, 0.4]}, )" + std::string(flow))),
              start + "box.max[2]: is 0.4, must not be below min, which is 0.5");
    EXPECT_EQ(
        refusalOf(emitter(R"("disc": {"centre": [0, 0, 0], "normal": [0, 0, 0], "radius": 1}, )" + std::string(flow))),
        start + "disc.normal: has no length");
    EXPECT_EQ(refusalOf(emitter(R"("disc": {"centre": [0, 0, 0], "normal": [0, 0, 1], "radius": 1, "hole": 1}, )" +
                                std::string(flow))),
              start + "disc.hole: is 1 m, must be below the radius, 1 m");
    EXPECT_EQ(
        refusalOf(emitter(R"("cylinder": {"from": [0, 0, 0], "to": [0, 0, 0], "radius": 1}, )" + std::string(flow))),
        start + "cylinder.to: is (0, 0, 0), must differ from `from`");
    EXPECT_EQ(refusalOf(emitter(R"("cylinder": {"from": [0, 0, 0], "to": [0, 0, 1], "radius": 1, "open": true}, )" +
                                std::string(flow))),
              start + "cylinder.open: is true; a region is the inside of a solid shape: leave it out");
}

TEST(Emitters, AreLimitedInNumberAndFlow) {
    std::string many;
    for (int k = 0; k < 17; ++k) many += (k > 0 ? ", {" : "{") + std::string(ball) + ", " + std::string(flow) + "}";
    EXPECT_EQ(refusalOf("\"emitters\": [" + many + "]"), "emitters: has 17 entries, must have at most 16");
    const std::string most = std::string(ball) + R"(, "rate": 200000, "radius": {"constant": 0.001})";
    EXPECT_EQ(refusalOf(emitter(most)), "accepted");
    EXPECT_EQ(
        refusalOf("\"emitters\": [{" + most + "}, {" + most + "}]"),
        "emitters[1]: brings the emitters to 6666.67 spheres in a step, at most 4096 are allowed; lower the flow, "
        "or shorten the step");
}

TEST(Emitters, AreRefusedWithoutAnyFreePlace) {
    EXPECT_EQ(refusalOf(emitter(R"("sphere": {"centre": [3, 0.5, 0.5], "radius": 0.1}, )" + std::string(flow)))
                  .find("emitters[0]: has no place between the walls and obstacles in 2048 tries"),
              0U);
    EXPECT_EQ(refusalOf(with(R"("name": "a")") +
                        R"(, "obstacles": [{"box": {"min": [0.1, 0.1, 0.1], "max": [0.9, 0.9, 0.9]}}])")
                  .find("emitters[0]: has no place"),
              0U);
}

// A sphere of 1 cm takes 4.19e-6 m^3. At 1 m/s through 0.01 m^2, 2,400 spheres per second are 1.006 of the volume.
TEST(Emitters, RefuseAStreamThatIsTooDense) {
    const std::string disc = R"("box": {"min": [0.4, 0.4, 0.5], "max": [0.5, 0.5, 0.5]}, "velocity": [0, 0, -1], )";
    EXPECT_EQ(refusalOf(emitter(disc + R"("rate": 2400, "radius": {"constant": 0.01})"))
                  .find("emitters[0]: makes a stream with spheres in 1.01 of its volume"),
              0U);
    EXPECT_EQ(refusalOf(emitter(disc + R"("rate": 700, "radius": {"constant": 0.01})")), "accepted");
}

// The share of the volume follows from the mass flow alone, however wide the distribution of the radii is.
TEST(Emitters, MeasureAStreamOfManySizes) {
    for (const char* const radii : {R"({"logNormal": {"median": 0.004, "deviation": 0.5, "min": 0.001, "max": 0.05}})",
                                    R"({"table": {"radii": [0.001, 0.002, 0.05], "shares": [0, 0.99, 1]}})"}) {
        const auto refusal = [&](double share) {
            return refusalOf(emitter(
                fmt::format(R"("box": {{"min": [0.4, 0.4, 0.5], "max": [0.5, 0.5, 0.5]}}, "velocity": [0, 0, -1], )"
                            R"("massFlow": {}, "radius": {})",
                            share * 0.01 * 1000, radii)));
        };
        EXPECT_EQ(refusal(0.299), "accepted") << radii;
        EXPECT_EQ(refusal(0.302).find("emitters[0]: makes a stream with spheres in 0.302 of its volume"), 0U) << radii;
    }
}

Emitter made(const std::string& members) {
    return sceneWith(members).emitters.at(0);
}

TEST(Emitters, WorkAsTheirScheduleSays) {
    const Emitter always = made(with(R"("begin": 2)"));
    EXPECT_EQ(always.workedUntil(1), 0);
    EXPECT_EQ(always.workedUntil(5), 3);
    EXPECT_EQ(always.timeAfter(3), 5);
    const Emitter twice = made(with(R"("schedule": [{"from": 1, "to": 2}, {"from": 4, "to": 6}])"));
    EXPECT_EQ(twice.workedUntil(1.5), 0.5);
    EXPECT_EQ(twice.workedUntil(3), 1);
    EXPECT_EQ(twice.workedUntil(5), 2);
    EXPECT_EQ(twice.workedUntil(100), 3);
    EXPECT_EQ(twice.timeAfter(2.5), 5.5);
    EXPECT_EQ(twice.timeAfter(3.5), std::numeric_limits<double>::infinity());
    const Emitter again = made(with(R"("begin": -1, "schedule": [{"from": 1, "to": 2}], "repeat": 3)"));
    EXPECT_EQ(again.workedUntil(0.5), 0.5);
    EXPECT_EQ(again.workedUntil(2), 1);
    EXPECT_EQ(again.workedUntil(300), 100);
    EXPECT_EQ(again.timeAfter(1.25), 3.25);
}

// The longest time with the shortest schedule.
TEST(Emitters, CountAllRepetitionsOfTheirSchedule) {
    const Emitter shortest = made(with(R"("begin": -1e9, "schedule": [{"to": 1e-6}], "repeat": 2e-6)"));
    EXPECT_NEAR(shortest.workedUntil(1e9), 1e9, 1);
}

// timeAfter() is the inverse of workedUntil().
TEST(Emitters, FindTheTimeOfRandomAmountsOfWork) {
    Random random(7);
    for (int k = 0; k < 200; ++k) {
        Emitter emitter;
        emitter.begin = random.uniform(-5, 5);
        double end = 0;
        for (int span = 0; span < 1 + k % 4; ++span) {
            const double from = end + random.uniform(0, 1);
            end = from + random.uniform(0.01, 1);
            emitter.schedule.push_back({from, end});
        }
        if (k % 2 == 0) emitter.repeat = end + random.uniform(0, 1);
        const double all = emitter.workedUntil(emitter.begin + end);
        const double worked = random.uniform(0, k % 2 == 0 ? 20 * all : all);
        EXPECT_NEAR(emitter.workedUntil(emitter.timeAfter(worked)), worked, 1e-9) << k;
    }
}

// Mean and variance of places in each kind of region, by their exact values. 20,000 places: 5 deviations.
TEST(Emitters, MakeSpheresUniformlyInTheirRegion) {
    constexpr int count = 20'000;
    const auto moments = [](const std::string& region, const glm::dvec3& centre, const glm::dvec3& variance) {
        const Emitter one = made(emitter(region + ", " + std::string(flow)));
        glm::dvec3 sum(0);
        glm::dvec3 squares(0);
        for (int k = 0; k < count; ++k) {
            const glm::dvec3 d = one.place(static_cast<std::uint64_t>(k), 0) - centre;
            sum += d;
            squares += d * d;
        }
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(sum[axis] / count, 0, 5 * std::sqrt(variance[axis] / count) + 1e-15) << region << axis;
            EXPECT_NEAR(squares[axis] / count, variance[axis], 5 * 2 * variance[axis] / std::sqrt(count) + 1e-15)
                << region << axis;
        }
    };
    moments(R"("box": {"min": [0.2, 0.3, 0.5], "max": [0.8, 0.7, 0.5]})", {0.5, 0.5, 0.5}, {0.36 / 12, 0.16 / 12, 0});
    moments(R"("sphere": {"centre": [0.5, 0.5, 0.5], "radius": 0.3})", {0.5, 0.5, 0.5}, glm::dvec3(0.09 / 5));
    moments(R"("cylinder": {"from": [0.5, 0.5, 0.2], "to": [0.5, 0.5, 0.8], "radius": 0.2})", {0.5, 0.5, 0.5},
            {0.04 / 4, 0.04 / 4, 0.36 / 12});
    moments(R"("disc": {"centre": [0.5, 0.5, 0.5], "normal": [2, 0, 0], "radius": 0.3, "hole": 0.2})", {0.5, 0.5, 0.5},
            {0, 0.13 / 4, 0.13 / 4});
}

TEST(Emitters, MakeTheSameSpheresAgain) {
    const std::string members = with(R"("velocitySpread": 0.5)");
    const Emitter one = made(members);
    const Emitter same = made(members);
    const Emitter other = made(with(R"("velocitySpread": 0.5, "seed": 2)"));
    int equal = 0;
    for (std::uint64_t k = 0; k < 50; ++k) {
        EXPECT_EQ(one.sphere(k).velocity, same.sphere(k).velocity);
        EXPECT_EQ(one.place(k, 3), same.place(k, 3));
        EXPECT_NE(one.place(k, 3), one.place(k, 4));
        EXPECT_LE(glm::length(one.sphere(k).velocity), 0.5F);
        equal += one.place(k, 0) == other.place(k, 0) ? 1 : 0;
    }
    EXPECT_EQ(equal, 0);
    const Scene two = sceneWith("\"emitters\": [{" + std::string(ball) + ", " + std::string(flow) + "}, {" +
                                std::string(ball) + ", " + std::string(flow) + "}]");
    EXPECT_NE(two.emitters[0].place(0, 0), two.emitters[1].place(0, 0)) << "emitters with the same seed differ";
    for (const Emitter& emitter : two.emitters)
        EXPECT_EQ(emitter.samples[5].position, emitter.place(5, 0)) << "samples are spheres that it makes";
}

TEST(Emitters, HaveAGroupBehindTheOthers) {
    const Scene scene = sceneWith(
        R"("materials": [{"name": "a"}, {"name": "b"}], "groups": [{"name": "g", "radius": {"constant": 0.1}, "list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]}}], )" +
        with(R"("name": "e", "material": "b", "colour": "#102030", "metal": 0.5)"));
    ASSERT_EQ(scene.groups.size(), 2U);
    EXPECT_EQ(scene.groups[1].name, "e");
    EXPECT_EQ(scene.groups[1].count, 0U);
    EXPECT_EQ(scene.groups[1].material, 1);
    EXPECT_EQ(scene.groups[1].look.colour, "#102030");
    EXPECT_EQ(scene.emitters[0].group, 1);
    EXPECT_EQ(scene.emitters[0].sphere(0).group, 1);
    EXPECT_EQ(scene.emitters[0].sphere(0).material, 1);
}

TEST(Emitters, GoOnInASavedScene) {
    const Scene scene = sceneWith("\"emitters\": [{" + std::string(ball) + ", " + std::string(flow) +
                                  R"(, "total": 10, "begin": 1}, {)" + std::string(ball) + ", " + std::string(flow) +
                                  R"(, "total": 5}])");
    const std::vector<EmitterProgress> progress{{.born = 3}, {.born = 5, .ended = true}};
    const v1::Scene saved = describe(scene, 4, progress);
    ASSERT_EQ(saved.emitters_size(), 1) << "the other one is done";
    EXPECT_EQ(saved.emitters(0).total(), 7U);
    EXPECT_EQ(saved.emitters(0).begin(), -3);
    EXPECT_EQ(saved.emitters(0).rate(), 100);
}

TEST(Emitters, KeepTheirGroupWhenEmptyOnesGo) {
    Scene scene = sceneWith(
        R"("groups": [{"radius": {"constant": 0.1}, "list": {}}, {"name": "g", "radius": {"constant": 0.1}, "list": {"spheres": [{"position": [0.5, 0.5, 0.5]}]}}], )" +
        with(R"("name": "e")"));
    removeEmptyGroups(scene);
    ASSERT_EQ(scene.groups.size(), 2U);
    EXPECT_EQ(scene.groups[scene.spheres[0].group].name, "g");
    EXPECT_EQ(scene.groups[scene.emitters[0].group].name, "e");
    EXPECT_EQ(scene.emitters[0].samples[0].group, 1);
}

}  // namespace
}  // namespace spherule::scene
