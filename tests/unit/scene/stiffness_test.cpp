#include "scene/stiffness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "scene_support.h"

namespace spherule::scene::testing {
namespace {

constexpr double pi = std::numbers::pi;

// One sphere of 5 cm in the unit cube without gravity, which moves at `speed` (m/s).
Scene flying(double speed, const std::string& material = "", const std::string& overlap = "0.01") {
    return sceneWith(R"("gravity": [0, 0, 0], "materials": [)" + object(material) +
                     R"(], "quality": {"model": "ACCURATE", "overlap": )" + overlap + "}, " +
                     group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.5], "radius": 0.05, "velocity": [0, 0, )" +
                           std::to_string(speed) + "]}]}"));
}

Stiffness lawOf(const Scene& scene, std::uint8_t a = 0, std::uint8_t b = 0) {
    return stiffnessBetween(scene, a, b, springModulus(scene));
}

double massOf(const Scene& scene) {
    const Sphere& sphere = scene.spheres.at(0);
    return 4.0 / 3 * pi * std::pow(static_cast<double>(sphere.radius), 3) * scene.materials[sphere.material].density;
}

// Returns the contact time (s) of two bodies with this reduced mass (kg) and approach speed (m/s). `force` (N) depends
// on the overlap (m). It is integrated in steps of `h` (s).
double contactUnder(auto force, double mass, double speed, double h) {
    double x = h * speed;
    double v = speed;
    double time = h;
    for (; x > 0; time += h) {
        v -= h / mass * force(x);
        x += h * v;
    }
    return time;
}

TEST(SceneStiffness, FollowsHertzIfAModulusIsGiven) {
    EXPECT_FALSE(followsHertz(flying(1)));
    EXPECT_TRUE(followsHertz(flying(1, R"("young": 1e7)")));
    EXPECT_TRUE(followsHertz(sceneWith(R"("materials": [{}, {"name": "steel", "young": 1e7}])")));
    EXPECT_GT(springModulus(flying(1)), 0);
    EXPECT_EQ(springModulus(flying(1, R"("young": 1e7)")), 0);
}

TEST(SceneStiffness, FastestImpactReachesTheGivenOverlap) {
    for (const double overlap : {0.01, 0.002}) {
        const Scene scene = flying(2, R"("density": 2500)", std::to_string(overlap));
        const auto r = static_cast<double>(scene.spheres[0].radius);
        const double modulus = lawOf(scene).normal;
        // m* v^2 = k d^2, for two equal spheres and for one sphere at a wall.
        EXPECT_NEAR(2 * std::sqrt(massOf(scene) / 2 / (2 * modulus * r / 2)) / r, overlap, 1e-6 * overlap);
        EXPECT_NEAR(2 * std::sqrt(massOf(scene) / (2 * modulus * r)) / r, overlap, 1e-6 * overlap);
    }
}

TEST(SceneStiffness, StiffnessScalesWithTheSquareOfSpeedOverOverlap) {
    const double one = lawOf(flying(1)).normal;
    EXPECT_NEAR(lawOf(flying(2)).normal / one, 4, 1e-6);
    EXPECT_NEAR(lawOf(flying(10)).normal / one, 100, 1e-4);
    EXPECT_NEAR(lawOf(flying(1, "", "0.001")).normal / one, 100, 1e-6);
    EXPECT_NEAR(lawOf(flying(1, R"("density": 3000)")).normal / one, 3, 1e-6);
    EXPECT_NEAR(lawOf(flying(1e-3)).normal / one, 1e-6, 1e-12) << "however slow it is";
}

TEST(SceneStiffness, WeightOfAPileCausesAFifthOfTheOverlap) {
    const std::string pile = R"("quality": {"model": "ACCURATE", "overlap": 0.5}, )" +
                             group(R"("lattice": {"min": [0, 0, 0], "max": [1, 1, 1], "spacing": 0.1},
                                      "radius": {"constant": 0.05})");
    const Scene scene = sceneWith(pile);
    ASSERT_EQ(scene.spheres.size(), 1000U);
    // The lowest layer carries the weight of all spheres at 100 contacts. Each has the force k d with k = 2 Y R* = Y r.
    const double load = massOf(scene) * 9.81 * 1000 / 100;
    const auto r = static_cast<double>(scene.spheres[0].radius);
    EXPECT_NEAR(load / (lawOf(scene).normal * r) / r, 0.2 * 0.5, 1e-6);
}

TEST(SceneStiffness, TangentialIsTwoSeventhsOfNormal) {
    const Stiffness law = lawOf(flying(1));
    EXPECT_DOUBLE_EQ(law.tangential, 2.0 / 7 * law.normal);
}

TEST(SceneStiffness, HertzAndMindlinUseEffectiveModuli) {
    const Scene scene = sceneWith(R"("materials": [{"young": 2e8, "poisson": 0.3},
                                                   {"name": "felt", "young": 1e6, "poisson": 0.45}])");
    const auto shear = [](double young, double poisson) { return young / (2 * (1 + poisson)); };
    const double normal = 1 / ((1 - 0.3 * 0.3) / 2e8 + (1 - 0.45 * 0.45) / 1e6);
    const double tangential = 1 / ((2 - 0.3) / shear(2e8, 0.3) + (2 - 0.45) / shear(1e6, 0.45));
    for (const Stiffness& law : {lawOf(scene, 0, 1), lawOf(scene, 1, 0)}) {
        EXPECT_NEAR(law.normal / normal, 1, 1e-12);
        EXPECT_NEAR(law.tangential / tangential, 1, 1e-12);
    }
    const Stiffness alike = lawOf(scene);
    EXPECT_NEAR(alike.normal / (2e8 / (2 * (1 - 0.3 * 0.3))), 1, 1e-12);
    EXPECT_NEAR(alike.tangential / (shear(2e8, 0.3) / (2 * (2 - 0.3))), 1, 1e-12);
}

TEST(SceneStiffness, DampingFollowsFromTheRestitutionOfThePair) {
    const Scene scene = sceneWith(R"("materials": [{"name": "felt", "restitution": 0.2}, {"name": "steel"},
        {"name": "ice"}], "pairs": [{"a": "steel", "b": "ice", "restitution": 0.9}])");
    EXPECT_EQ(lawOf(scene, 0, 1).damping, dampingRatio(0.2));
    EXPECT_EQ(lawOf(scene, 1, 1).damping, dampingRatio(0.5));
    EXPECT_EQ(lawOf(scene, 2, 1).damping, dampingRatio(0.9));
}

TEST(SceneContactTime, ExpectsInitialSpeedsAndFalls) {
    EXPECT_NEAR(contactTimeOf(flying(0)).speed, 0.05 / 30 * 60, 1e-6) << "a thirtieth of its radius in a step";
    EXPECT_NEAR(contactTimeOf(flying(3)).speed, 3, 1e-6);
    Scene scene = flying(3);
    scene.forces.gravity = {0, 0, -9.81};
    EXPECT_NEAR(contactTimeOf(scene).speed, std::sqrt(9 + 2 * 9.81 * 0.5), 1e-6);
    scene.spheres[0].position = {0.2, 0.5, 0.9};
    EXPECT_NEAR(contactTimeOf(scene).speed, std::sqrt(9 + 2 * 9.81 * 0.9), 1e-6);
    scene.forces.gravity = {9.81, 0, 0};
    EXPECT_NEAR(contactTimeOf(scene).speed, std::sqrt(9 + 2 * 9.81 * 0.8), 1e-6) << "down is where gravity points";
}

TEST(SceneContactTime, ExpectsHeadOnCollisions) {
    Scene scene = flying(3);
    scene.spheres.push_back(scene.spheres[0]);
    scene.spheres[1].velocity = {0, 0, -1};
    EXPECT_NEAR(contactTimeOf(scene).speed, 6, 1e-6) << "twice the fastest";
    scene.forces.gravity = {0, 0, -9.81};
    EXPECT_NEAR(contactTimeOf(scene).speed, std::sqrt(36 + 2 * 9.81 * 0.5), 1e-6) << "which falls once";
    scene.forces.gravity = {};
    const double modulus = springModulus(scene);
    scene.sphereContacts = false;
    EXPECT_NEAR(contactTimeOf(scene).speed, 3, 1e-6) << "they meet walls alone";
    EXPECT_NEAR(springModulus(scene) / modulus, 0.25, 1e-6);
}

// 50 spheres with random speeds of up to 1 m/s.
Scene swarm(std::uint64_t seed) {
    Scene scene = sceneWith(R"("gravity": [0, 0, 0], "quality": {"model": "ACCURATE"})");
    scene.bounds.min = glm::dvec3(-1);
    scene.bounds.max = glm::dvec3(1);
    scene.bounds.open.fill(true);
    Random random(seed);
    for (int k = 0; k < 50; ++k) {
        Sphere sphere{.radius = static_cast<float>(random.uniform(0.01, 0.05))};
        for (int axis = 0; axis < 3; ++axis) {
            sphere.position[axis] = random.uniform(-0.9, 0.9);
            sphere.velocity[axis] = static_cast<float>(random.uniform(-0.5, 0.5));
        }
        scene.spheres.push_back(sphere);
    }
    return scene;
}

std::uint32_t substepsOf(Scene scene) {
    EXPECT_TRUE(fitSubsteps(scene));
    return scene.quality.substeps;
}

void move(Scene& scene, const glm::vec3& by) {
    for (Sphere& sphere : scene.spheres) sphere.velocity += by;
}

TEST(SceneContactTime, DoesNotDependOnCommonMotion) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        Scene scene = swarm(seed);
        const ContactTime at = contactTimeOf(scene);
        move(scene, {10, -20, 5});
        EXPECT_NEAR(contactTimeOf(scene).speed / at.speed, 1, 1e-5);
        EXPECT_NEAR(contactTimeOf(scene).contact / at.contact, 1, 1e-5);
        scene.forces.gravity = {0, 0, -9.81};
        EXPECT_NEAR(contactTimeOf(scene).speed / at.speed, 1, 1e-5) << "they fall together";
        scene.bounds.open[ZMin] = false;
        EXPECT_GT(contactTimeOf(scene).speed, 5) << "the floor does not";
    }
}

TEST(SceneContactTime, IgnoresMotionAlongFrictionlessPlanes) {
    Scene scene = swarm(4);
    scene.bounds.open[ZMin] = false;
    scene.obstacles.push_back({planeShape({0, -1, 0}, {0, 1, 0}), 0, ""});
    const double at = contactTimeOf(scene).speed;
    move(scene, {10, 0, 0});
    EXPECT_NEAR(contactTimeOf(scene).speed, at, 0.05 * at);
    move(scene, {-10, 10, 0});
    EXPECT_GT(contactTimeOf(scene).speed, 10) << "onto the plane, or back from it";
    move(scene, {10, -10, 0});
    scene.materials[0].friction = 0.1;
    EXPECT_GT(contactTimeOf(scene).speed, 10) << "a rough floor stops some, and others come after them";
    scene.materials[0].friction = 0;
    scene.obstacles.push_back({boxShape({{0, 0, 0}, {0.1, 0.1, 0.1}}), 0, ""});
    EXPECT_GT(contactTimeOf(scene).speed, 10) << "a box is in the way of every motion";
}

TEST(SceneContactTime, ScalesWithTheScene) {
    for (const double length : {1e-3, 1e3}) {
        for (const double time : {0.1, 10.0}) {
            for (const bool moving : {true, false}) {
                Scene scene = swarm(5);
                scene.forces.gravity = {0, 0, -9.81};
                if (!moving)
                    for (Sphere& sphere : scene.spheres) sphere.velocity = {};
                scene.bounds.open[ZMin] = !moving;
                const std::uint32_t substeps = substepsOf(scene);
                const ContactTime at = contactTimeOf(scene);
                scene.bounds.min *= length;
                scene.bounds.max *= length;
                scene.step *= time;
                scene.forces.gravity *= length / (time * time);
                for (Sphere& sphere : scene.spheres) {
                    sphere.position *= length;
                    sphere.radius *= static_cast<float>(length);
                    sphere.velocity *= static_cast<float>(length / time);
                }
                EXPECT_NEAR(contactTimeOf(scene).contact / at.contact, time, 1e-5 * time);
                EXPECT_NEAR(contactTimeOf(scene).overlap / at.overlap, 1, 1e-5);
                EXPECT_NEAR(substepsOf(scene), substeps, 1);
            }
        }
    }
}

// Returns the largest overlap / radius of a sphere with a wall of the same material, by Hertz's law.
double depthAfter(const Scene& scene, double speed) {
    const auto r = static_cast<double>(scene.spheres[0].radius);
    return std::pow(15 * massOf(scene) * speed * speed / (16 * lawOf(scene).normal * std::sqrt(r)), 0.4) / r;
}

TEST(SceneYoung, IsRefusedIfSpheresWouldFallThroughTheFloor) {
    const std::string falling = R"("materials": [{"young": 1e3}], "quality": {"model": "ACCURATE"}, )" +
                                group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.9], "radius": 0.05}]})");
    const std::string refusal = refusalOf(falling);
    EXPECT_EQ(refusal.find("materials[0].young: is 1e+03 Pa, so soft that spheres give way by more than half a radius "
                           "under the impacts and the weight of this scene; give at least "),
              0U)
        << refusal;
    const double least = std::stod(refusal.substr(refusal.rfind("least ") + 6));
    const auto with = [&](double young) {
        Scene scene = sceneWith(R"("materials": [{"young": 1e9}], "quality": {"model": "ACCURATE"}, )" +
                                group(R"("list": {"spheres": [{"position": [0.5, 0.5, 0.9], "radius": 0.05}]})"));
        scene.materials[0].young = young;
        return scene;
    };
    Scene enough = with(least);
    EXPECT_TRUE(fitSubsteps(enough));
    EXPECT_NEAR(depthAfter(enough, contactTimeOf(enough).speed), 0.5, 0.003);
    Scene tooSoft = with(0.98 * least);
    EXPECT_FALSE(fitSubsteps(tooSoft));
    tooSoft.quality.substepsFixed = true;
    tooSoft.quality.substeps = 1000;
    EXPECT_FALSE(fitSubsteps(tooSoft)) << "no substeps help";
    tooSoft.quality.model = Model::Balanced;
    EXPECT_TRUE(fitSubsteps(tooSoft)) << "whose spheres are hard";
    enough.forces.gravity *= 2;
    EXPECT_FALSE(fitSubsteps(enough));
    enough.bounds.open.fill(true);
    EXPECT_TRUE(fitSubsteps(enough)) << "there is nothing to fall on";
}

TEST(SceneYoung, SupportsThePile) {
    // The impacts of falling spheres are weak, but the lowest 100 spheres carry 1,000.
    const std::string pile = group(R"("lattice": {"min": [0, 0, 0], "max": [1, 1, 1], "spacing": 0.1},
                                      "radius": {"constant": 0.05})");
    Scene scene = sceneWith(R"("materials": [{"young": 1e9}], "quality": {"model": "ACCURATE"}, )" + pile);
    for (Sphere& sphere : scene.spheres) sphere.position.z = 0.05;
    const double force = massOf(scene) * 9.81 * 1000 / 100;
    const auto r = static_cast<double>(scene.spheres[0].radius);
    // F = 4/3 E* sqrt(R*) d^1.5 for two spheres.
    const double modulus = force / (4.0 / 3 * std::sqrt(r / 2) * std::pow(0.5 * r, 1.5));
    const double young = modulus * 2 * (1 - 0.25 * 0.25);
    scene.materials[0].young = 1.01 * young;
    EXPECT_TRUE(fitSubsteps(scene));
    scene.materials[0].young = 0.99 * young;
    EXPECT_FALSE(fitSubsteps(scene));
}

TEST(SceneYoung, ErrorNamesTheSofterMaterial) {
    Scene scene = flying(5, R"("young": 1e9)");
    scene.materials.push_back({.name = "felt", .young = 1e3});
    EXPECT_TRUE(fitSubsteps(scene)) << "nothing is of felt";
    scene.bounds.material = 1;
    const auto fits = fitSubsteps(scene);
    ASSERT_FALSE(fits);
    EXPECT_EQ(fits.error().where, "materials[1].young");
    const std::string text = fits.error().text();
    scene.materials[1].young = std::stod(text.substr(text.rfind("least ") + 6));
    EXPECT_TRUE(fitSubsteps(scene));
}

TEST(SceneContactTime, MatchesLinearSprings) {
    const Scene scene = flying(1);
    const double stiffness = lawOf(scene).normal * static_cast<double>(scene.spheres[0].radius);
    const ContactTime time = contactTimeOf(scene);
    const auto force = [stiffness](double x) { return stiffness * x; };
    EXPECT_NEAR(contactUnder(force, massOf(scene) / 2, time.speed, 1e-4 * time.contact) / time.contact, 1, 0.001);
}

TEST(SceneContactTime, MatchesHertz) {
    for (const std::string material : {R"("young": 1e7)", R"("young": 2e9, "poisson": 0.4, "density": 3000)"}) {
        const Scene scene = flying(1, material);
        const double reduced = static_cast<double>(scene.spheres[0].radius) / 2;
        const double stiffness = 4.0 / 3 * lawOf(scene).normal * std::sqrt(reduced);
        const ContactTime time = contactTimeOf(scene);
        const auto force = [stiffness](double x) { return stiffness * std::pow(std::max(x, 0.0), 1.5); };
        const double contact = contactUnder(force, massOf(scene) / 2, time.speed, 1e-4 * time.contact);
        EXPECT_NEAR(contact / time.contact, 1, 0.001) << material;
    }
}

TEST(SceneContactTime, ContactHasSeventySubsteps) {
    for (const std::string material : {"", R"("young": 2e8)", R"("young": 1e11, "poisson": 0.45)"}) {
        for (const double speed : {0.0, 1.0, 50.0}) {
            const Scene scene = flying(speed, material);
            const ContactTime time = contactTimeOf(scene);
            EXPECT_LE(time.substep, time.contact / 70 * (1 + 1e-12)) << material << " at " << speed;
            EXPECT_GT(time.substep, 0);
            EXPECT_LE(scene.step / scene.quality.substeps, time.substep * (1 + 1e-12)) << "and it is what is taken";
        }
    }
}

TEST(SceneContactTime, SubstepIsATenthOfTheRayleighTime) {
    const Scene scene = flying(0, R"("young": 1e10, "poisson": 0.3, "density": 2000)");
    const double shear = 1e10 / (2 * 1.3);
    const double rayleigh = pi * 0.05 * std::sqrt(2000 / shear) / (0.163 * 0.3 + 0.8766);
    EXPECT_NEAR(contactTimeOf(scene).substep / (rayleigh / 10), 1, 1e-6);
    EXPECT_GT(contactTimeOf(scene).contact / 70, rayleigh / 10) << "so slow an impact takes longer";
}

TEST(SceneContactTime, UsesTheSmallestSphereAndTheStiffestSurface) {
    const std::string spheres = R"("groups": [
        {"list": {"spheres": [{"position": [0.3, 0.5, 0.5], "radius": 0.1}]}},
        {"list": {"spheres": [{"position": [0.7, 0.5, 0.5], "radius": 0.01}]}}])";
    const std::string felt = R"({"young": 1e8})";
    const std::string steel = R"({"name": "steel", "young": 1e11})";
    const double soft = contactTimeOf(sceneWith("\"materials\": [" + felt + "], " + spheres)).contact;
    const std::string both = "\"materials\": [" + felt + ", " + steel + "], ";
    EXPECT_EQ(contactTimeOf(sceneWith(both + spheres)).contact, soft) << "nothing is of steel";
    const std::string plate =
        R"("obstacles": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "material": "steel"}])";
    const double plated = contactTimeOf(sceneWith(both + plate + ", " + spheres)).contact;
    // E* is almost twice as large, because only the felt is deformed.
    EXPECT_NEAR(plated / soft, std::pow(0.5, 0.4), 0.001);
    const double large = contactTimeOf(sceneWith("\"materials\": [" + felt + R"(], "groups": [
        {"list": {"spheres": [{"position": [0.3, 0.5, 0.5], "radius": 0.1}]}}])"))
                             .contact;
    EXPECT_NEAR(large / soft, 10, 1e-3);
}

TEST(SceneContactTime, WithoutContactsIsInfiniteWithOneSubstep) {
    const ContactTime time = contactTimeOf(sceneWith(R"("quality": {"model": "ACCURATE"})"));
    EXPECT_TRUE(std::isinf(time.contact));
    EXPECT_EQ(time.substep, 1.0 / 60);
}

}  // namespace
}  // namespace spherule::scene::testing
