#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "measure/cases.h"
#include "measure/scenes.h"
#include "scene/stiffness.h"

// Spheres at rest on each other.
namespace spherule::measure {

namespace {

double weightOf(const sim::State& state) {
    double mass = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) mass += massOf(state, id);
    return mass * earth;
}

// Returns the force (N) of all spheres on the floor, from their overlaps and the linear springs of `accurate`.
double springForceOnFloor(const scene::Scene& scene, const sim::State& state) {
    const double modulus = scene::springModulus(scene);
    double force = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const double r = radiusOf(state, id);
        const double overlap = scene.bounds.min.z + r - positionOf(state, id).z;
        force += overlap > 0 ? 2 * modulus * r * overlap : 0;
    }
    return force;
}

// Returns the upward force (N) of the tangential springs at the sides. Walls with friction carry a share of a bed, or
// push it down.
double springForceOnSides(sim::Simulation& simulation, const sim::State& state) {
    const double modulus =
        scene::stiffnessBetween(simulation.scene(), 0, 0, scene::springModulus(simulation.scene())).tangential;
    const auto stretches = simulation.pipeline().read<glm::vec4>(sim::Array::WallSlip);
    double force = 0;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
        const auto surface = static_cast<int>(stretches[k].w) - 1;
        if (surface < scene::XMin || surface > scene::YMax) continue;
        const auto id = static_cast<std::uint32_t>(k / (stretches.size() / state.count()));
        force -= 2 * modulus * radiusOf(state, id) * static_cast<double>(stretches[k].z);
    }
    return force;
}

// Adds the mean force on the floor over `steps`. With springs it is their force plus the force at the sides. Otherwise
// it follows from the missing momentum.
Result<void> addFloorForce(Bench& bench, sim::Simulation& simulation, int steps) {
    const sim::State before = simulation.snapshot();
    const double weight = weightOf(before);
    double springs = 0;
    for (int k = 0; k < steps; ++k) {
        if (auto done = bench.step(simulation); !done) return done;
        if (!bench.accurate()) continue;
        const sim::State state = simulation.snapshot();
        springs += (springForceOnFloor(simulation.scene(), state) + springForceOnSides(simulation, state)) / steps;
    }
    const double gained = momentumOf(simulation.snapshot()).z - momentumOf(before).z;
    const double balance = weight + gained / (steps * simulation.scene().step);
    bench.add(against("force on the floor", bench.accurate() ? springs : balance, weight, "N"));
    return {};
}

Result<void> stack(Bench& bench) {
    constexpr double r = 0.05;
    constexpr int count = 5;
    scene::Scene scene = closedBox(1.2);
    for (int k = 0; k < count; ++k) addSphere(scene, {0, 0, -0.6 + r + 2.02 * r * k}, r);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    if (auto done = bench.run(**opened, 3); !done) return done;
    const sim::State state = (*opened)->snapshot();
    const double top = positionOf(state, count - 1).z - scene.bounds.min.z;
    bench.add(against("sinking of the top", (2 * count - 1) * r - top, 0, "m", r));
    bench.add(plain("fastest", (*opened)->statistics().speedMax, "m/s"));
    return addFloorForce(bench, **opened, 30);
}

// Returns the share of the volume that spheres fill, away from walls, floor and surface. It counts points of a fine
// lattice.
double packingOf(const sim::State& state, const scene::Scene& scene, double height) {
    const double r = radiusOf(state, 0);
    const glm::dvec3 low = scene.bounds.min + 3 * r;
    glm::dvec3 high = scene.bounds.max - 3 * r;
    high.z = scene.bounds.min.z + height - 3 * r;
    const double pitch = 0.25 * r;
    std::uint64_t inside = 0;
    std::uint64_t points = 0;
    for (double z = low.z; z < high.z; z += pitch) {
        std::vector<glm::dvec3> layer;
        for (std::uint32_t id = 0; id < state.count(); ++id)
            if (std::abs(positionOf(state, id).z - z) < r) layer.push_back(positionOf(state, id));
        for (double y = low.y; y < high.y; y += pitch)
            for (double x = low.x; x < high.x; x += pitch) {
                ++points;
                inside += std::ranges::any_of(layer, [&](const glm::dvec3& centre) {
                    const glm::dvec3 d = centre - glm::dvec3(x, y, z);
                    return glm::dot(d, d) < r * r;
                });
            }
    }
    return points > 0 ? static_cast<double>(inside) / static_cast<double>(points) : 0;
}

struct BedSize {
    std::uint32_t count = 0;
    double radius = 0;  // m
    double across = 0;  // width, in diameters
    double friction = 0;
};

Result<void> bed(Bench& bench, const BedSize& size, const char* curve) {
    scene::Scene scene = lattice(size.count, size.radius, size.across);
    setFriction(scene, size.friction);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    // The time of a fall is proportional to the square root of the lengths.
    const double settle = (bench.quick() ? 1.2 : 3) * std::sqrt(size.radius / 0.05);
    if (auto done = bench.run(**opened, settle); !done) return done;
    bench.startClock();
    if (auto done = bench.run(**opened, 0.25); !done) return done;
    const sim::Statistics s = (*opened)->statistics();
    Figure mean = against("overlap, mean", s.overlapMean, 0, "of r", 1);
    mean.curve = curve;
    bench.add(mean);
    bench.add(against("overlap, largest", s.overlapMax, 0, "of r", 1));
    bench.add(against("depth in walls, largest", s.wallOverlapMax, 0, "of r", 1));
    bench.add(plain("rms speed", s.speedRms, "m/s"));
    const sim::State state = (*opened)->snapshot();
    std::vector<double> heights;
    for (std::uint32_t id = 0; id < state.count(); ++id)
        heights.push_back(positionOf(state, id).z - scene.bounds.min.z + size.radius);
    std::ranges::sort(heights);
    bench.add(plain("packing fraction", packingOf(state, scene, heights[heights.size() * 95 / 100]), ""));
    return addFloorForce(bench, **opened, bench.accurate() ? 10 : 30);
}

Result<void> bedWithFriction(Bench& bench) {
    return bed(bench, {bench.quick() ? 400U : 1000U, 0.05, 8.1, 0.3}, "bed overlap");
}

}  // namespace

std::vector<Case> restCases() {
    return {{.suite = "accuracy", .name = "stack of five", .run = stack},
            {.suite = "accuracy", .name = "bed", .run = bedWithFriction},
            {.suite = "accuracy",
             .name = "bed without friction",
             .run =
                 [](Bench& bench) {
                     return bed(bench, {1000, 0.05, 8.1, 0}, "");
                 },
             .everyRung = false,
             .whenQuick = false},
            {.suite = "accuracy",
             .name = "bed 40 deep",
             .run =
                 [](Bench& bench) {
                     return bed(bench, {2000, 0.05, 7.1, 0.3}, "");
                 },
             .everyRung = false,
             .whenQuick = false},
            {.suite = "accuracy",
             .name = "bed of 1 cm spheres",
             .run =
                 [](Bench& bench) {
                     return bed(bench, {1000, 0.01, 8.1, 0.3}, "");
                 },
             .everyRung = false,
             .whenQuick = false}};
}

}  // namespace spherule::measure
