// Contacts of the model `accurate`: against an integration of the same law in double, and what must hold whatever the
// case. Without sleep and gravity; several seeds.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/stiffness.h"
#include "soft_reference.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr int phases = 25;    // of a substep in which contact begins
constexpr double before = 3;  // substeps

struct Setting {
    bool hertz = false;
    bool walls = false;
    double friction = 0;
};

class ObliqueImpact : public testing::TestWithParam<Setting> {};

scene::Scene soft(const Setting& setting, double restitution) {
    scene::Scene scene = openSpace(40);
    scene.step = 1e-3;
    scene.materials = {{.density = 1000, .restitution = restitution, .friction = setting.friction},
                       {.name = "other", .density = 2500, .restitution = restitution, .friction = setting.friction}};
    if (setting.hertz) {
        scene.materials[0].young = 1e7;
        scene.materials[1].young = 3e7;
        scene.materials[1].poisson = 0.4;
    }
    scene.quality = {.model = scene::Model::Accurate, .pinned = false, .overlap = 0.05};
    scene.sphereContacts = !setting.walls;
    scene.bounds.min.z = -1;
    scene.bounds.max.z = 1;
    if (setting.walls) scene.bounds.open[scene::ZMin] = false;
    return scene;
}

// A velocity against -z, at 20 to 80 degrees to it.
glm::dvec3 obliquely(scene::Random& random) {
    const double angle = random.uniform(20, 80) * std::numbers::pi / 180;
    const double about = random.uniform(0, 2 * std::numbers::pi);
    const double speed = random.uniform(0.8, 1.2);
    return speed * glm::dvec3(std::sin(angle) * std::cos(about), std::sin(angle) * std::sin(about), -std::cos(angle));
}

reference::SoftBody bodyOf(const sim::State& state, std::uint32_t id) {
    return {positionOf(state, id), velocityOf(state, id), glm::dvec3(glm::vec3(state.spin[id])),
            static_cast<double>(state.position[id].w), 1 / massOf(state, id)};
}

reference::SoftLaw lawOf(const scene::Scene& scene, std::uint8_t a, std::uint8_t b, double friction) {
    const scene::Stiffness law = scene::stiffnessBetween(scene, a, b, scene::springModulus(scene));
    return {scene::followsHertz(scene), law.normal, law.tangential, law.damping, friction};
}

// Rows of spheres over the floor, or of pairs; in a row, all do the same, and touch in another phase of a substep.
void place(scene::Scene& scene, scene::Random& random, bool walls, int rows) {
    for (int row = 0; row < rows; ++row) {
        const glm::vec3 v(obliquely(random));
        const auto r = static_cast<float>(random.uniform(0.04, 0.06));
        const auto other = static_cast<float>(random.uniform(0.04, 0.06));
        for (int k = 0; k < phases; ++k) {
            const glm::dvec3 at(0.5 * (k - phases / 2), 0.8 * (row - rows / 2), 0);
            scene.spheres.push_back({.position = at, .velocity = v, .radius = r});
            if (!walls) scene.spheres.push_back({.position = at, .radius = other, .material = 1});
        }
    }
}

void setHeights(scene::Scene& scene, bool walls) {
    const double h = scene.step / scene.quality.substeps;
    for (std::size_t k = 0; k < scene.spheres.size(); k += walls ? 1 : 2) {
        scene::Sphere& sphere = scene.spheres[k];
        const double phase = (static_cast<double>(k / (walls ? 1 : 2) % phases) + 0.5) / phases;
        const double gap = -static_cast<double>(sphere.velocity.z) * h * (before + phase);
        sphere.position.z = walls ? scene.bounds.min.z + static_cast<double>(sphere.radius) + gap
                                  : static_cast<double>(sphere.radius + scene.spheres[k + 1].radius) + gap;
    }
}

TEST_P(ObliqueImpact, TurnsSpheresAsTheLawSaysWhateverThePhase) {
    constexpr double ofReference = 0.01;
    constexpr double overPhases = 0.005;
    constexpr int rows = 4;
    double worst = 0;
    double widest = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        for (const double e : {0.7, 0.9}) {
            const bool walls = GetParam().walls;
            const double friction = GetParam().friction;
            scene::Random random(seed);
            scene::Scene scene = soft(GetParam(), e);
            place(scene, random, walls, rows);
            ASSERT_TRUE(scene::fitSubsteps(scene));
            setHeights(scene, walls);
            const auto simulation = simulate(scene);
            const sim::State start = simulation->snapshot();
            const double floor = -0.5 * (scene.bounds.max.z - scene.bounds.min.z);
            // Contacts of the slower take longer.
            run(*simulation, 2.5 * scene::contactTimeOf(scene).contact + scene.step);
            const sim::State end = simulation->snapshot();
            const std::uint32_t each = walls ? 1 : 2;
            for (std::uint32_t row = 0; row < rows; ++row) {
                const std::uint32_t first = row * phases * each;
                reference::SoftBody a = bodyOf(start, first);
                reference::SoftBody b = bodyOf(start, first + each - 1);
                if (walls) {
                    a.x.z -= floor;
                    meetFloor(a, lawOf(scene, 0, 0, friction));
                } else {
                    meet(a, b, lawOf(scene, 0, 1, friction));
                }
                const double expected = a.rotationalEnergy() + (walls ? 0 : b.rotationalEnergy());
                double least = 1e30;
                double most = 0;
                for (std::uint32_t id = first; id < first + phases * each; id += each) {
                    double got = bodyOf(end, id).rotationalEnergy();
                    if (!walls) got += bodyOf(end, id + 1).rotationalEnergy();
                    least = std::min(least, got / expected);
                    most = std::max(most, got / expected);
                }
                SCOPED_TRACE(testing::Message() << "seed " << seed << ", e = " << e << ", row " << row << ", velocity "
                                                << start.velocity[first].x << " " << start.velocity[first].y << " "
                                                << start.velocity[first].z);
                EXPECT_GT(least, 1 - ofReference);
                EXPECT_LT(most, 1 + ofReference);
                EXPECT_LT(most - least, overPhases);
                worst = std::max({worst, std::abs(least - 1), std::abs(most - 1)});
                widest = std::max(widest, most - least);
            }
        }
    }
    RecordProperty("worst", std::to_string(worst));
    RecordProperty("overPhases", std::to_string(widest));
}

std::vector<Setting> settings() {
    std::vector<Setting> all;
    for (const bool hertz : {false, true})
        for (const bool walls : {false, true})
            for (const double friction : {0.2, 0.4, 0.6, 0.8}) all.push_back({hertz, walls, friction});
    return all;
}

INSTANTIATE_TEST_SUITE_P(Of, ObliqueImpact, testing::ValuesIn(settings()), [](const auto& parameter) {
    const Setting& of = parameter.param;
    return std::string(of.hertz ? "Hertz" : "Linear") + (of.walls ? "Wall" : "Pair") +
           std::to_string(std::lround(10 * of.friction));
});

}  // namespace
}  // namespace spherule::physics
