#include "support.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>

namespace spherule::physics {

compute::Device& device() {
    static const std::unique_ptr<compute::Device> only = openTestDevice();
    return *only;
}

scene::Scene named(const std::string& name, const scene::Overrides& overrides) {
    return support::valueOf(scene::load(name, "software", overrides));
}

scene::Scene fineStepSpace(double side) {
    scene::Scene scene = measure::openSpace(side);
    scene.step = 1.0 / 480;
    scene.quality.substeps = 1;
    return scene;
}

scene::Scene fineStepBox(double side) {
    scene::Scene scene = fineStepSpace(side);
    scene.bounds.open.fill(false);
    scene.forces.gravity = {0, 0, -earth};
    return scene;
}

scene::Scene sleepyBox(double side) {
    scene::Scene scene = fineStepBox(side);
    scene.step = 1.0 / 60;
    scene.quality.substeps = 8;
    scene.sleep.enabled = true;
    setRestitution(scene, 0.3);
    return scene;
}

std::unique_ptr<sim::Simulation> simulate(scene::Scene scene, compute::Device& on) {
    return support::valueOf(sim::Simulation::create(on, std::move(scene)));
}

void run(sim::Simulation& simulation, double seconds) {
    const auto steps = std::lround(seconds / simulation.scene().step);
    for (long k = 0; k < steps; ++k)
        if (auto done = simulation.step(); !done) throw std::runtime_error(done.error().text());
}

reference::World referenceOf(const scene::Scene& scene, const sim::State& state) {
    reference::World world;
    world.gravity = scene.forces.gravity;
    world.contacts = scene.sphereContacts;
    const auto restitutionOf = [&](std::uint8_t material) { return scene.materials[material].restitution; };
    const glm::dvec3 centre = scene.bounds.centre();
    for (unsigned face = 0; face < 6; ++face) {
        if (scene.bounds.open[face]) continue;
        glm::dvec3 normal{};
        normal[static_cast<int>(face / 2)] = face % 2 == 0 ? 1 : -1;
        world.walls.push_back({(face % 2 == 0 ? scene.bounds.min : scene.bounds.max) - centre, normal,
                               restitutionOf(scene.bounds.material)});
    }
    for (const scene::Obstacle& obstacle : scene.obstacles) {
        const auto& plane = std::get<scene::Plane>(obstacle.shape);
        world.walls.push_back({plane.point - centre, plane.normal, restitutionOf(obstacle.material)});
    }
    for (std::uint32_t id = 0; id < state.count(); ++id)
        world.spheres.push_back({positionOf(state, id), velocityOf(state, id),
                                 static_cast<double>(state.position[id].w), 1 / massOf(state, id),
                                 restitutionOf(scene.spheres[id].material)});
    return world;
}

std::uint64_t touchingPairs(sim::Simulation& simulation) {
    std::uint64_t sum = 0;
    for (const glm::uvec4& group : simulation.pipeline().read<glm::uvec4>(sim::Array::GroupRange)) sum += group.z;
    return sum;
}

std::vector<SlotPair> listedPairs(sim::Simulation& simulation) {
    const auto span = simulation.pipeline().read<glm::uvec4>(sim::Array::GroupRange);
    const auto pairs = simulation.pipeline().read<glm::uvec2>(sim::Array::Pairs);
    std::vector<SlotPair> found;
    for (const glm::uvec4& group : span)
        for (std::uint32_t k = group.x; group.y != UNLISTED && k < group.x + group.y; ++k)
            found.emplace_back(std::min(pairs[k].x, pairs[k].y), std::max(pairs[k].x, pairs[k].y));
    std::ranges::sort(found);
    return found;
}

bool asleep(const sim::State& state, std::uint32_t id) {
    return state.velocity[id].w < 0;
}

std::uint32_t sleepers(const sim::State& state) {
    std::uint32_t count = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id)
        if (asleep(state, id)) ++count;
    return count;
}

bool allFinite(const sim::State& state) {
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const glm::dvec3 sum = positionOf(state, id) + velocityOf(state, id);
        if (!std::isfinite(sum.x + sum.y + sum.z)) return false;
    }
    return true;
}

}  // namespace spherule::physics
