// The figures of each sphere that frames carry, and inspections of one sphere, against double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "sim/inspection.h"
#include "support.h"

namespace spherule::physics {
namespace {

constexpr double rounding = 1e-6;  // m: a gap this close to the tolerance may be on either side of it

struct Figures {
    int contacts = 0;  // -1: rounding may decide
    double overlap = 0;
    double energy = 0;  // J
};

// Adds a body at `gap` (m) that touches up to `tolerance` (m). `radius`: the smaller one (m).
void add(Figures& figures, double gap, double tolerance, double radius) {
    if (figures.contacts < 0 || std::abs(gap - tolerance) < rounding)
        figures.contacts = -1;
    else if (gap < tolerance)
        ++figures.contacts;
    figures.overlap = std::max(figures.overlap, -gap / radius);
}

void addSurfaces(Figures& figures, const scene::Scene& scene, const glm::dvec3& x, double radius) {
    for (unsigned face = 0; face < 6; ++face) {
        const int axis = static_cast<int>(face / 2);
        const double distance = face % 2 == 0 ? x[axis] - scene.bounds.min[axis] : scene.bounds.max[axis] - x[axis];
        if (scene.bounds.walled(face)) add(figures, distance - radius, 2e-4 * radius, radius);
    }
    for (const scene::Obstacle& obstacle : scene.obstacles)
        add(figures, obstacle.shape->distance(x) - radius, 2e-4 * radius, radius);
}

std::vector<Figures> expectedOf(const scene::Scene& scene, const sim::State& state) {
    std::vector<Figures> all(state.count());
    for (std::uint32_t a = 0; a < state.count(); ++a) {
        const double radius = radiusOf(state, a);
        if (!scene.spheres[a].fixed) {
            addSurfaces(all[a], scene, positionOf(state, a), radius);
            const double mass = massOf(state, a);
            const glm::dvec3 v = velocityOf(state, a);
            const glm::dvec3 spin = spinOf(state, a);
            all[a].energy = 0.5 * mass * glm::dot(v, v) + 0.2 * mass * radius * radius * glm::dot(spin, spin);
        }
        for (std::uint32_t b = 0; b < a; ++b) {
            if (scene.spheres[a].fixed && scene.spheres[b].fixed) continue;
            const double other = radiusOf(state, b);
            const glm::dvec3 d = scene::separation(positionOf(state, a), positionOf(state, b), scene.bounds.periods());
            const double gap = glm::length(d) - radius - other;
            for (const std::uint32_t id : {a, b}) add(all[id], gap, 1e-4 * (radius + other), std::min(radius, other));
        }
    }
    return all;
}

// Reads the figures from the device, in the order of ids.
std::vector<glm::vec4> figuresOf(sim::Simulation& simulation) {
    EXPECT_TRUE(simulation.pipeline().figures());
    const auto bySlot = simulation.pipeline().read<glm::vec4>(sim::figuresArray);
    const sim::SlotState slots = simulation.pipeline().download();
    std::vector<glm::vec4> byId(simulation.count());
    for (std::size_t slot = 0; slot < byId.size(); ++slot)
        byId[simulation.population().rankOfHandle(slots.idAndMaterial[slot] & sim::Pipeline::idMask)] = bySlot[slot];
    return byId;
}

// A bed of spheres of many sizes that fall into each other, over obstacles, partly fixed.
scene::Scene bed(scene::Model model, std::uint64_t seed, bool periodic) {
    scene::Scene scene = fineStepBox(0.8);
    scene.bounds.open[scene::ZMax] = true;
    scene.bounds.periodic[0] = periodic;
    if (periodic) {
        scene.bounds.min.x = -0.6;  // long enough for the cells
        scene.bounds.max.x = 0.6;
    }
    scene.materials[0].friction = 0.4;
    if (!periodic)
        scene.obstacles.push_back({scene::planeShape({-0.3, 0, 0}, {std::sqrt(0.5), 0, std::sqrt(0.5)}), 0, ""});
    scene.obstacles.push_back({scene::boxShape({{0.1, 0.1, -0.4}, {0.3, 0.3, -0.2}}), 0, ""});
    scene::Random random(seed);
    for (int k = 0; k < 400; ++k) {
        const glm::dvec3 place(random.uniform(-0.2, 0.35), random.uniform(-0.35, 0.35), random.uniform(-0.1, 0.4));
        measure::addSphere(scene, place, random.uniform(0.02, 0.05)).fixed = k % 10 == 0;
    }
    scene.quality.model = model;
    scene.quality.substepsFixed = false;
    EXPECT_TRUE(scene::fitSubsteps(scene));
    return scene;
}

class FiguresOf : public testing::TestWithParam<scene::Model> {
  protected:
    static std::unique_ptr<sim::Simulation> settled(std::uint64_t seed, bool periodic, compute::Device& on = device()) {
        auto simulation = simulate(bed(GetParam(), seed, periodic), on);
        run(*simulation, GetParam() == scene::Model::Accurate ? 0.03 : 0.3);
        return simulation;
    }
};

TEST_P(FiguresOf, SpheresAreThoseOfAllPairsAndSurfaces) {
    for (const bool periodic : {false, true}) {
        const auto simulation = settled(periodic ? 2 : 1, periodic);
        const std::vector<glm::vec4> found = figuresOf(*simulation);
        const sim::State state = simulation->snapshot();
        const std::vector<Figures> expected = expectedOf(simulation->scene(), state);
        int sure = 0;
        double contacts = 0;
        double overlaps = 0;
        double energy = 0;
        for (std::uint32_t id = 0; id < state.count(); ++id) {
            EXPECT_NEAR(found[id].y, expected[id].overlap, 2e-6 / radiusOf(state, id)) << id;
            EXPECT_NEAR(found[id].z, expected[id].energy, 1e-6 * expected[id].energy) << id;
            overlaps += expected[id].overlap;
            energy += expected[id].energy;
            if (expected[id].contacts < 0) continue;
            ++sure;
            contacts += static_cast<double>(found[id].x);
            EXPECT_EQ(found[id].x, static_cast<float>(expected[id].contacts)) << id;
        }
        EXPECT_GT(sure, 300);
        EXPECT_GT(contacts, 100);
        EXPECT_GT(overlaps, 0.01);
        EXPECT_GT(energy, 0.001);
    }
}

// Looking at figures changes nothing, and statistics do not spoil them.
TEST_P(FiguresOf, SpheresAreComputedWithoutAnEffect) {
    const auto watched = settled(3, false);
    const auto alone = settled(3, false);
    for (int k = 0; k < 5; ++k) {
        (void)watched->statistics();
        EXPECT_TRUE(watched->pipeline().figures());
        EXPECT_TRUE(sim::inspect(*watched, 7, "sphere"));
        ASSERT_TRUE(watched->step());
        ASSERT_TRUE(alone->step());
    }
    EXPECT_EQ(sim::hashOf(watched->snapshot()), sim::hashOf(alone->snapshot()));
}

// Chains of frames that begin later share the figures of a state. Before the first step, reading builds the lists.
TEST_P(FiguresOf, SpheresStayWhileOthersReadTheState) {
    const auto simulation = simulate(bed(GetParam(), 5, false), device());
    EXPECT_TRUE(simulation->pipeline().figures());
    const auto before = simulation->pipeline().read<glm::vec4>(sim::figuresArray);
    (void)simulation->statistics();
    EXPECT_TRUE(sim::inspect(*simulation, 7, "sphere"));
    EXPECT_EQ(simulation->pipeline().read<glm::vec4>(sim::figuresArray), before);
}

TEST_P(FiguresOf, AnInspectedSphereAreThoseOfItsState) {
    const auto simulation = settled(4, true);
    ASSERT_TRUE(simulation->apply(sim::Remove{.spheres = {0, 17, 200}}));
    const sim::State state = simulation->snapshot();
    const scene::Scene& scene = simulation->scene();
    const std::vector<Figures> expected = expectedOf(scene, state);
    std::size_t surfaces = 0;
    for (std::uint32_t rank = 0; rank < state.count(); rank += 3) {
        const std::uint64_t id = state.idAt(rank);
        const auto seen = sim::inspect(*simulation, id, "sphere");
        ASSERT_TRUE(seen) << seen.error().text();
        EXPECT_EQ(seen->sphere, id);
        EXPECT_LT(glm::distance(seen->position, positionOf(state, rank) + scene.bounds.centre()), 1e-6);
        EXPECT_EQ(seen->velocity, velocityOf(state, rank));
        EXPECT_EQ(seen->spin, spinOf(state, rank));
        EXPECT_EQ(seen->mass.has_value(), !scene.spheres[rank].fixed);
        if (seen->mass) {
            EXPECT_NEAR(*seen->mass, massOf(state, rank), 1e-6 * massOf(state, rank));
        }
        EXPECT_DOUBLE_EQ(seen->radius, radiusOf(state, rank));
        if (expected[rank].contacts >= 0) {
            EXPECT_EQ(seen->touches, static_cast<std::uint32_t>(expected[rank].contacts));
        }
        EXPECT_EQ(seen->contacts.size(), seen->touches);
        if (!seen->contacts.empty()) {
            EXPECT_NEAR(std::max(0.0, seen->contacts.front().overlap), expected[rank].overlap,
                        2e-6 / radiusOf(state, rank));
        }
        for (const sim::TouchedBody& touched : seen->contacts) {
            const auto* const other = std::get_if<std::uint64_t>(&touched.body);
            if (other == nullptr) {
                const std::set<std::string> names{"Y_MIN", "Y_MAX", "Z_MIN", "obstacles[0]"};
                EXPECT_TRUE(names.contains(std::get<std::string>(touched.body)));
                ++surfaces;
                continue;
            }
            const auto at = simulation->population().rankOf(*other);
            ASSERT_TRUE(at);
            const double reach = radiusOf(state, rank) + radiusOf(state, *at);
            const glm::dvec3 d =
                scene::separation(positionOf(state, rank), positionOf(state, *at), scene.bounds.periods());
            EXPECT_LT(glm::length(d), reach * (1 + 1e-4) + rounding);
        }
    }
    EXPECT_GT(surfaces, 0U);
    const auto gone = sim::inspect(*simulation, 17, "sphere");
    ASSERT_FALSE(gone);
    EXPECT_EQ(gone.error().text(), "sphere: is 17, a sphere that was removed");
    EXPECT_EQ(gone.error().cause, Cause::NoSuchSphere);
}

INSTANTIATE_TEST_SUITE_P(In, FiguresOf,
                         testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& parameter) { return std::string(scene::nameOf(parameter.param)); });

// Without contacts between spheres, walls alone count; without walls, nothing does.
TEST(Figures, OfDustAreThoseOfWalls) {
    scene::Scene scene = fineStepBox(1);
    scene.sphereContacts = false;
    measure::addSphere(scene, {0, 0, -0.45}, 0.05);
    measure::addSphere(scene, {0, 0.01, -0.46}, 0.05);
    measure::addSphere(scene, {0.46, 0.46, 0}, 0.05);
    measure::addSphere(scene, {0.3, 0.3, 0}, 0.05).velocity = {2, 0, 0};
    const auto found = figuresOf(*simulate(scene));
    EXPECT_EQ(std::vector<float>({found[0].x, found[1].x, found[2].x, found[3].x}), std::vector<float>({1, 1, 2, 0}));
    EXPECT_NEAR(found[1].y, 0.2, 1e-5);
    EXPECT_EQ(found[3].y, 0);
    EXPECT_NEAR(found[3].z, 2000 * 4.0 / 3 * std::acos(-1) * std::pow(0.05, 3), 1e-5);
    const auto seen = sim::inspect(*simulate(scene), 2, "sphere");
    ASSERT_TRUE(seen) << seen.error().text();
    EXPECT_EQ(seen->touches, 2U);
    scene::Scene empty = fineStepSpace(1);
    empty.sphereContacts = false;
    measure::addSphere(empty, {0.46, 0.46, 0}, 0.05);
    EXPECT_EQ(figuresOf(*simulate(empty))[0], glm::vec4(0));
}

// A large sphere touches more than an inspection tells.
TEST(Figures, OfAnInspectionTellTheDeepestContacts) {
    scene::Scene scene = fineStepSpace(2);
    measure::addSphere(scene, {0, 0, 0}, 0.4);
    const int count = 150;
    for (int k = 0; k < count; ++k) {
        const double z = 1 - (2.0 * k + 1) / count;
        const double angle = 2.399963 * k;
        const double flat = std::sqrt(1 - z * z);
        measure::addSphere(scene, (0.42 - 1e-5 * k) * glm::dvec3(flat * std::cos(angle), flat * std::sin(angle), z),
                           0.02);
    }
    const auto simulation = simulate(scene);
    const auto seen = sim::inspect(*simulation, 0, "sphere");
    ASSERT_TRUE(seen) << seen.error().text();
    EXPECT_EQ(seen->touches, static_cast<std::uint32_t>(count));
    ASSERT_EQ(seen->contacts.size(), sim::Inspection::mostContacts);
    for (std::size_t k = 0; k < seen->contacts.size(); ++k)
        EXPECT_EQ(std::get<std::uint64_t>(seen->contacts[k].body), count - k);
}

}  // namespace
}  // namespace spherule::physics
