#include "beds.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {

namespace {

constexpr double r = bedRadius;

scene::Scene openBox(double side, double height) {
    scene::Scene scene = fineStepBox(side);
    scene.bounds.min.z = -height / 2;
    scene.bounds.max.z = height / 2;
    scene.bounds.open[scene::ZMax] = true;
    scene.step = 1.0 / 60;
    scene.quality.substeps = 8;
    return scene;
}

// Adds a lattice of `count` spheres. Its lowest layer is 0.2 r above `floor`. `gap`: spacing along x and y, m.
void addLattice(scene::Scene& scene, std::uint32_t count, std::uint32_t perRow, double gap, double layer, double floor,
                std::uint64_t seed) {
    scene::Random random(seed);
    for (std::uint32_t k = 0; k < count; ++k) {
        const double x = gap * (k % perRow - 0.5 * (perRow - 1)) + random.uniform(-0.1, 0.1) * r;
        const double y = gap * (k / perRow % perRow - 0.5 * (perRow - 1)) + random.uniform(-0.1, 0.1) * r;
        const double z = floor + 1.2 * r + k / (perRow * perRow) * layer + random.uniform(-0.1, 0.1) * r;
        measure::addSphere(scene, {x, y, z}, r);
    }
}

// The tray: its inner width, the height of its bottom, and of its rim above the bottom, in m.
constexpr double trayWidth = 1.1;
constexpr double trayBottom = -1.2;
constexpr double trayRim = r;
constexpr double roomHeight = 4;

}  // namespace

scene::Scene bed(const BedOf& size) {
    const double side = 2 * r * std::sqrt(size.count / size.depth);
    const auto perRow = std::max(1U, static_cast<std::uint32_t>(side / (size.pitch * r)));
    const std::uint32_t layers = (size.count + perRow * perRow - 1) / (perRow * perRow);
    scene::Scene scene = openBox(side, size.pitch * r * (layers + 1));
    scene.materials[0].friction = size.friction;
    addLattice(scene, size.count, perRow, side / perRow, size.pitch * r, scene.bounds.min.z, size.seed);
    return scene;
}

scene::Scene heapOnTray(double friction, std::uint64_t seed) {
    scene::Scene scene = openBox(6, roomHeight);
    scene.materials[0].friction = friction;
    scene.bounds.material = addMaterial(scene, {.restitution = 0.5, .friction = 1, .rollingResistance = 0.5});
    const double half = trayWidth / 2;
    constexpr double thick = 0.04;
    const auto add = [&](glm::dvec3 min, glm::dvec3 max) {
        scene.obstacles.push_back({scene::boxShape({min, max}), 0, ""});
    };
    const double low = trayBottom - 0.2;
    const double high = trayBottom + trayRim;
    add({-half - thick, -half - thick, low}, {half + thick, half + thick, trayBottom});
    for (const double side : {-1.0, 1.0}) {
        const double from = side < 0 ? -half - thick : half;
        add({from, -half - thick, low}, {from + thick, half + thick, high});
        add({-half, from, low}, {half, from + thick, high});
    }
    addLattice(scene, 648, 9, 2.4 * r, 2.4 * r, trayBottom + 0.1 * r, seed);
    scene::Random random(seed, 1);
    for (scene::Sphere& sphere : scene.spheres) sphere.radius *= static_cast<float>(random.uniform(0.9, 1.1));
    return scene;
}

Heap heapOf(const sim::State& state) {
    Heap heap;
    double squares = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        if (positionOf(state, id).z < trayBottom) continue;
        ++heap.spheres;
        squares += glm::dot(velocityOf(state, id), velocityOf(state, id));
    }
    heap.speedRms = std::sqrt(squares / std::max(1, heap.spheres));
    return heap;
}

scene::Scene bedUnderLargeSphere(std::uint64_t seed) {
    constexpr double side = 26 * r;
    constexpr std::uint32_t perRow = 11;
    constexpr double pitch = 2.2 * r;
    scene::Scene scene = openBox(side, 3);
    scene.materials[0].friction = 0.3;
    addLattice(scene, 1200, perRow, side / perRow, pitch, scene.bounds.min.z, seed);
    measure::addSphere(scene, {0.01, -0.02, scene.bounds.min.z + 11 * pitch + 10 * r}, 10 * r);
    return scene;
}

double largeSphereHeight(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    const scene::Bounds& bounds = simulation.scene().bounds;
    return positionOf(state, state.count() - 1).z + bounds.centre().z - bounds.min.z;
}

scene::Scene asAccurate(scene::Scene scene, double overlap) {
    scene.quality = {.model = scene::Model::Accurate, .substepsFixed = false, .overlap = overlap};
    if (auto fits = scene::fitSubsteps(scene); !fits) throw std::runtime_error(fits.error().text());
    return scene;
}

void runIn(const Frame& frame, sim::Simulation& simulation, double seconds) {
    run(simulation, seconds * frame.scale);
}

Rest restOf(sim::Simulation& simulation, const scene::Scene& before, const Frame& frame) {
    constexpr int samples = 12;
    Rest rest;
    double squares = 0;
    for (int k = 0; k < samples; ++k) {
        runIn(frame, simulation, 1.0 / 60);
        const sim::Statistics now = simulation.statistics();
        rest.overlap += now.overlapMean / samples;
        rest.wallOverlap = std::max(rest.wallOverlap, now.wallOverlapMax);
        squares += now.speedRms * now.speedRms / samples;
        rest.speedMax = std::max(rest.speedMax, now.speedMax);
        rest.height += meanHeightOf(simulation.snapshot(), frame, before.bounds.min.z) / samples;
    }
    rest.speedRms = std::sqrt(squares);
    return rest;
}

}  // namespace spherule::physics
