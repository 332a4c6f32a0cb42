// The times at which emitters make spheres, and spheres without a free place.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "scene/random.h"
#include "scene_support.h"
#include "sim/emission.h"
#include "sim/layout.h"

namespace spherule::sim {
namespace {

using scene::testing::sceneWith;

scene::Scene withEmitter(const std::string& members, const std::string& more = "") {
    return sceneWith(more +
                     R"("gravity": [0, 0, 0], "emitters": [{"sphere": {"centre": [0.5, 0.5, 0.5], "radius": 0.2}, )"
                     R"("radius": {"uniform": {"min": 0.001, "max": 0.002}}, )" +
                     members + "}]");
}

// Does `steps` steps in which `happens(birth)` tells which births are possible.
template <class Happens>
void advance(Emission& emission, const scene::Scene& scene, int first, int steps, Happens happens) {
    for (int k = first; k < first + steps; ++k) {
        const auto& births = emission.attempt(scene, k * scene.step, (k + 1) * scene.step);
        std::vector<bool> happened;
        for (const scene::Sphere& birth : births) happened.push_back(happens(birth));
        emission.settle(scene, happened, (k + 1) * scene.step);
    }
}

bool always(const scene::Sphere& /*birth*/) {
    return true;
}

bool never(const scene::Sphere& /*birth*/) {
    return false;
}

// The spheres born until a time do not depend on the length of the steps.
TEST(Emission, MakesARateExactly) {
    scene::Random random(3);
    for (int k = 0; k < 40; ++k) {
        const double rate = std::exp2(random.uniform(-2, 12));
        const double begin = random.uniform(-1, 1);
        const std::string step = "\"step\": " + std::to_string(random.uniform(0.001, 0.05)) + ", ";
        const scene::Scene scene =
            withEmitter("\"rate\": " + std::to_string(rate) + ", \"begin\": " + std::to_string(begin), step);
        Emission emission(scene, 0);
        const int steps = 200;
        advance(emission, scene, 0, steps, always);
        const double worked = scene.emitters[0].workedUntil(steps * scene.step) - scene.emitters[0].workedUntil(0);
        EXPECT_NEAR(static_cast<double>(emission.counts(scene, 0).born.spheres()), worked * rate, 1) << rate;
        EXPECT_EQ(emission.counts(scene, 0).waiting, 0U);
    }
}

TEST(Emission, MakesAMassFlowExactly) {
    const scene::Scene scene = withEmitter(R"("massFlow": 0.01)");
    Emission emission(scene, 0);
    advance(emission, scene, 0, 600, always);
    const double largest = 4.0 / 3 * 3.14159 * 0.002 * 0.002 * 0.002 * 1000;
    EXPECT_NEAR(emission.counts(scene, 0).born.mass(), 0.1, largest);
    EXPECT_NEAR(emission.counts(scene, 0).born.massPerSecond(10), 0.01, 2 * largest);
}

TEST(Emission, MakesNoSphereOfTheTimeBeforeItBegan) {
    for (const char* const flow : {R"("rate": 60, "begin": -100)", R"("massFlow": 0.001, "begin": -100)"}) {
        const scene::Scene scene = withEmitter(flow);
        Emission emission(scene, 0);
        advance(emission, scene, 0, 1, always);
        EXPECT_LE(emission.counts(scene, 0).born.spheres(), 4U) << flow;
    }
}

TEST(Emission, EndsWithItsTotal) {
    const scene::Scene scene = withEmitter(R"("rate": 600, "total": 100)");
    Emission emission(scene, 0);
    advance(emission, scene, 0, 5, always);
    EXPECT_EQ(emission.counts(scene, 0).born.spheres(), 50U);
    advance(emission, scene, 5, 100, always);
    EXPECT_EQ(emission.counts(scene, 0).born.spheres(), 100U);
}

TEST(Emission, TriesASphereInOtherPlacesAndThenCountsItAsBlocked) {
    const scene::Scene scene = withEmitter(R"("rate": 60, "total": 1)");
    Emission emission(scene, 0);
    std::vector<glm::dvec3> places;
    float radius = 0;
    advance(emission, scene, 0, 7, [&](const scene::Sphere& birth) {
        places.push_back(birth.position);
        EXPECT_EQ(birth.radius, places.size() == 1 ? birth.radius : radius) << "the same sphere";
        radius = birth.radius;
        return false;
    });
    ASSERT_EQ(places.size(), 7U);
    for (std::size_t k = 1; k < places.size(); ++k) EXPECT_NE(places[k], places[k - 1]);
    EXPECT_EQ(emission.counts(scene, 0).waiting, 1U);
    EXPECT_EQ(emission.counts(scene, 0).blocked, 0U);
    advance(emission, scene, 7, 1, never);
    EXPECT_EQ(emission.counts(scene, 0).waiting, 0U);
    EXPECT_EQ(emission.counts(scene, 0).blocked, 1U);
    advance(emission, scene, 8, 1, always);
    EXPECT_EQ(emission.counts(scene, 0).born.spheres(), 1U) << "blocked spheres do not count in the total";
}

// It ends when no place has been free for this time, and makes no more when places are free again.
TEST(Emission, EndsWhenItIsChoked) {
    for (const double rate : {20.0, 60.0, 3000.0}) {
        const scene::Scene scene = withEmitter(fmt::format(R"("rate": {}, "untilChoked": 0.5)", rate));
        Emission emission(scene, 0);
        advance(emission, scene, 0, 60, always);
        const std::uint64_t born = emission.counts(scene, 0).born.spheres();
        advance(emission, scene, 60, 25, never);
        EXPECT_FALSE(emission.counts(scene, 0).ended) << rate;
        advance(emission, scene, 85, 1, always);  // one free place begins the time anew
        advance(emission, scene, 86, 25, never);
        EXPECT_FALSE(emission.counts(scene, 0).ended) << rate;
        advance(emission, scene, 111, 60, never);
        EXPECT_TRUE(emission.counts(scene, 0).ended) << rate;
        EXPECT_EQ(emission.counts(scene, 0).waiting, 0U) << rate;
        const std::uint64_t last = emission.counts(scene, 0).born.spheres();
        EXPECT_GE(last, born) << rate;
        advance(emission, scene, 171, 100, always);
        EXPECT_EQ(emission.counts(scene, 0).born.spheres(), last) << rate;
        EXPECT_TRUE(emission.progress(scene)[0].ended) << rate;
        emission.replace(0, scene.emitters[0], 271 * scene.step);
        advance(emission, scene, 271, 60, always);
        EXPECT_GT(emission.counts(scene, 0).born.spheres(), last) << "a changed emitter begins again, rate " << rate;
    }
}

std::string emitterWith(const std::string& members) {
    return R"({"sphere": {"centre": [0.5, 0.5, 0.5], "radius": 0.2}, "radius": {"uniform": {"min": 0.001, "max": )"
           R"(0.002}}, )" +
           members + "}";
}

// Each sphere that has become due was born, waits, or counts as blocked. None is left for later, however many are.
TEST(Emission, CountsAllThatHaveBecomeDue) {
    scene::Random random(5);
    for (int k = 0; k < 12; ++k) {
        const double rate = k == 0 ? 240'000 : std::exp2(random.uniform(4, 16));
        const scene::Scene scene = withEmitter(fmt::format(R"("rate": {}, "schedule": [{{"to": 0.3}}])", rate));
        Emission emission(scene, 0);
        for (int step = 0; step < 30; ++step) {
            const bool free = random.uniform() < 0.3;
            advance(emission, scene, step, 1, free ? always : never);
            const auto counts = emission.counts(scene, 0);
            const auto due = static_cast<std::uint64_t>(
                std::ceil(scene.emitters[0].workedUntil((step + 1) * scene.step) * rate - 1e-6));
            EXPECT_EQ(counts.born.spheres() + counts.waiting + counts.blocked, due) << rate;
            EXPECT_LE(static_cast<double>(counts.waiting), 8 * (rate * scene.step + 1)) << rate;
        }
        EXPECT_EQ(emission.counts(scene, 0).waiting, 0U) << "the schedule has ended, rate " << rate;
    }
}

// An emitter without free places takes no places from others.
TEST(Emission, LetsABlockedEmitterHinderNoOther) {
    for (const double blocked : {60.0, 40'000.0, 239'000.0}) {
        const scene::Scene scene = sceneWith(
            R"("gravity": [0, 0, 0], "emitters": [)" + emitterWith(fmt::format(R"("rate": {})", blocked)) + ", " +
            emitterWith(R"("rate": 600)") + ", " + emitterWith(R"("massFlow": 0.001, "begin": 0.2)") + "]");
        const std::uint16_t ofBlocked = scene.emitters[0].group;
        Emission emission(scene, 0);
        advance(emission, scene, 0, 24, [&](const scene::Sphere& birth) { return birth.group != ofBlocked; });
        EXPECT_EQ(emission.counts(scene, 0).born.spheres(), 0U);
        EXPECT_EQ(emission.counts(scene, 1).born.spheres(), 240U) << blocked;
        EXPECT_EQ(emission.counts(scene, 1).blocked, 0U) << blocked;
        const double largest = 4.0 / 3 * 3.14159 * 0.002 * 0.002 * 0.002 * 1000;
        EXPECT_NEAR(emission.counts(scene, 2).born.mass(), 0.0002, largest) << blocked;
    }
}

// Emitters without free places share the places to try: each sphere that one of them makes has been tried.
TEST(Emission, SharesThePlacesToTry) {
    const scene::Scene scene =
        sceneWith(R"("gravity": [0, 0, 0], "emitters": [)" + emitterWith(R"("rate": 120000)") + ", " +
                  emitterWith(R"("rate": 100000)") + ", " + emitterWith(R"("rate": 3000)") + "]");
    Emission emission(scene, 0);
    for (int step = 0; step < 20; ++step) {
        const auto& births = emission.attempt(scene, step * scene.step, (step + 1) * scene.step);
        ASSERT_LE(births.size(), MOST_BIRTH_PLACES);
        std::vector<std::size_t> tried(scene.groups.size());
        for (const scene::Sphere& birth : births) ++tried[birth.group];
        const std::uint16_t small = scene.emitters[2].group;
        if (step > 10) {
            EXPECT_GE(tried[small], 150U) << "50 new ones, and a share of those that wait";
        }
        emission.settle(scene, std::vector<bool>(births.size()), (step + 1) * scene.step);
    }
}

// A sphere is where its flight since its time has taken it: the stream has no gaps between steps.
TEST(Emission, MakesAContinuousStream) {
    const scene::Scene scene =
        sceneWith(R"("gravity": [0, 0, -10], "emitters": [{"box": {"min": [0.1, 0.1, 0.5], "max": [0.9, 0.9, 0.5]}, )"
                  R"("radius": {"constant": 0.001}, "rate": 6000, "velocity": [0, 0, 3]}])");
    Emission emission(scene, 0);
    const double end = 0.05;
    const auto& births = emission.attempt(scene, end - scene.step, end);
    ASSERT_GE(births.size(), 100U);
    for (std::size_t k = births.size() - 100; k < births.size(); ++k) {
        const double flight = end - static_cast<double>(k) / 6000;
        if (flight > scene.step) continue;  // due in an earlier step
        EXPECT_NEAR(births[k].position.z, 0.5 + 3 * flight - 5 * flight * flight, 1e-9);
        EXPECT_NEAR(births[k].velocity.z, 3 - 10 * flight, 1e-6);
    }
}

TEST(FlowMeter, TellsTheLastFullSecond) {
    FlowMeter meter;
    for (int k = 0; k < 25; ++k) meter.add(0.1 * k + 0.05, 2, 0.5);
    EXPECT_EQ(meter.spheres(), 50U);
    EXPECT_EQ(meter.mass(), 12.5);
    EXPECT_EQ(meter.spheresPerSecond(2.5), 20);
    EXPECT_EQ(meter.massPerSecond(2.5), 5);
    EXPECT_EQ(meter.spheresPerSecond(3.5), 10);
    EXPECT_EQ(meter.spheresPerSecond(4.5), 0);
}

}  // namespace
}  // namespace spherule::sim
