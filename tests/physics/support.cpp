#include "support.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/json.h"
#include "scene/quality.h"
#include "scene/shapes.h"
#include "scene/surroundings.h"

namespace spherule::physics {

compute::Device& device() {
    static const std::unique_ptr<compute::Device> only = openTestDevice();
    return *only;
}

scene::Scene named(const std::string& name, const scene::Overrides& overrides) {
    return support::valueOf(scene::load(name, "software", overrides));
}

scene::Obstacle obstacleFrom(const std::string& json) {
    const v1::Scene message = support::valueOf(scene::parseJson("{\"obstacles\":[" + json + "]}", "obstacle"));
    scene::Check check;
    scene::Obstacle obstacle = scene::readObstacle(check, message.obstacles(0), {scene::Material{}}, {}, "obstacle");
    if (!check.ok()) throw std::invalid_argument(check.error().value().message);
    return obstacle;
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

void measureContacts(scene::Scene& scene, scene::Model model) {
    scene.contactSums = true;
    scene.quality.model = model;
    scene.quality.substepsFixed = false;
    if (auto fits = scene::fitSubsteps(scene); !fits) throw std::runtime_error(fits.error().text());
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
    const auto materialOf = [&](std::uint8_t material) -> const scene::Material& { return scene.materials[material]; };
    const glm::dvec3 centre = scene.bounds.centre();
    for (unsigned face = 0; face < 6; ++face) {
        if (scene.bounds.open[face]) continue;
        glm::dvec3 normal{};
        normal[static_cast<int>(face / 2)] = face % 2 == 0 ? 1 : -1;
        world.walls.push_back({(face % 2 == 0 ? scene.bounds.min : scene.bounds.max) - centre, normal,
                               materialOf(scene.bounds.material).restitution,
                               materialOf(scene.bounds.material).friction});
    }
    for (const scene::Obstacle& obstacle : scene.obstacles) {
        const glm::dvec3 normal = obstacle.shape->normalOfHalfSpace().value();
        world.walls.push_back({-obstacle.shape->distance(centre) * normal, normal,
                               materialOf(obstacle.material).restitution, materialOf(obstacle.material).friction});
    }
    for (std::uint32_t id = 0; id < state.count(); ++id)
        world.spheres.push_back({positionOf(state, id), velocityOf(state, id),
                                 static_cast<double>(state.position[id].w), 1 / massOf(state, id),
                                 materialOf(scene.spheres[id].material).restitution,
                                 materialOf(scene.spheres[id].material).friction, spinOf(state, id)});
    return world;
}

namespace {

using Words = std::vector<std::uint32_t>;

Words idsOf(sim::Simulation& simulation) {
    Words ids = simulation.pipeline().read<std::uint32_t>(sim::Array::IdAndMaterial);
    ids.resize(simulation.count());  // the arrays have room for more spheres
    for (std::uint32_t& id : ids) id &= 0xffffffU;
    return ids;
}

// Three arrays of components, as vectors. Empty without these arrays.
class Components {
  public:
    Components(sim::Simulation& simulation, const std::array<sim::Array, 3>& arrays) {
        for (std::size_t axis = 0; axis < 3; ++axis) values_[axis] = simulation.pipeline().read<float>(arrays[axis]);
    }
    [[nodiscard]] glm::dvec3 at(std::size_t k) const {
        if (values_[0].empty()) return {};
        return {values_[0][k], values_[1][k], values_[2][k]};
    }

  private:
    std::array<std::vector<float>, 3> values_;
};

void readSpheres(reference::World& world, sim::Simulation& simulation) {
    const Words ids = idsOf(simulation);
    const auto velocity = simulation.pipeline().read<glm::vec4>(sim::Array::Velocity);
    const auto spin = simulation.pipeline().read<glm::vec4>(sim::Array::AngularVelocity);
    const auto unheld = simulation.pipeline().read<glm::vec4>(sim::Array::UnheldVelocity);
    const auto unheldSpin = simulation.pipeline().read<glm::vec4>(sim::Array::UnheldSpin);
    const Words xz = simulation.pipeline().read<std::uint32_t>(sim::Array::AccelerationXz);
    const Words yz = simulation.pipeline().read<std::uint32_t>(sim::Array::AccelerationYz);
    for (std::size_t slot = 0; slot < ids.size(); ++slot) {
        reference::Sphere& sphere = world.spheres[ids[slot]];
        const bool holds = unheld[slot].w != 0;
        sphere.heldVelocity = holds ? glm::dvec3(velocity[slot] - unheld[slot]) : glm::dvec3(0);
        sphere.acceleration = {std::bit_cast<float>(ACCELERATION_X_BITS(xz[slot], yz[slot])),
                               std::bit_cast<float>(ACCELERATION_Y_BITS(xz[slot], yz[slot])),
                               std::bit_cast<float>(ACCELERATION_Z_BITS(xz[slot], yz[slot]))};
        if (!unheldSpin.empty()) sphere.heldSpin = holds ? glm::dvec3(spin[slot] - unheldSpin[slot]) : glm::dvec3(0);
    }
}

void readPairs(reference::World& world, sim::Simulation& simulation) {
    using enum sim::Array;
    const Words ids = idsOf(simulation);
    const Words words = simulation.pipeline().read<std::uint32_t>(Bundles);
    const auto pairs = simulation.pipeline().read<glm::uvec2>(Pairs);
    const Components impulse(simulation, {ContactX, ContactY, ContactZ});
    const Components torque(simulation, {TorqueX, TorqueY, TorqueZ});
    const std::size_t bundles = simulation.plan().grid.bundles();
    const std::uint32_t half = words[bundles * BUNDLE_WORDS + WORD_HALF];
    for (std::size_t bundle = 0; bundle < bundles; ++bundle) {
        const std::uint32_t first = words[bundle * BUNDLE_WORDS];
        const std::uint32_t listed = words[bundle * BUNDLE_WORDS + 1];
        for (std::uint32_t k = first; listed != UNLISTED && k < first + listed; ++k) {
            const std::size_t a = ids[pairs[k].x];
            const std::size_t b = ids[SECOND_OF(pairs[k])];
            const double sign = a < b ? 1 : -1;
            if ((pairs[k].y & PAIR_REMEMBERS) != 0)
                world.pairsHold[std::minmax(a, b)] = {impulse.at(half + k) * sign, torque.at(half + k)};
        }
    }
}

void readWalls(reference::World& world, sim::Simulation& simulation) {
    const auto impulse = simulation.pipeline().read<glm::vec4>(sim::Array::WallImpulse);
    const auto torque = simulation.pipeline().read<glm::vec4>(sim::Array::WallTorque);
    std::array<std::size_t, 6> wallOfFace{};
    std::size_t faces = 0;
    for (std::size_t face = 0; face < 6; ++face)
        if (!simulation.scene().bounds.open[face]) wallOfFace[face] = faces++;
    for (std::size_t row = 0; row < impulse.size(); ++row) {
        if (impulse[row].w == 0) continue;
        const auto surface = static_cast<std::size_t>(impulse[row].w) - 1;
        const std::size_t wall = surface < 6 ? wallOfFace[surface] : faces + surface - 6;
        world.wallsHold[{row / simulation.plan().maxWallHistory, wall}] = {
            glm::dvec3(impulse[row]), torque.empty() ? glm::dvec3(0) : glm::dvec3(torque[row])};
    }
}

}  // namespace

reference::World referenceOf(sim::Simulation& simulation) {
    reference::World world = referenceOf(simulation.scene(), simulation.snapshot());
    readSpheres(world, simulation);
    if (world.contacts) readPairs(world, simulation);
    readWalls(world, simulation);
    return world;
}

std::uint64_t touchingPairs(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    const auto ids = simulation.pipeline().read<std::uint32_t>(sim::Array::IdAndMaterial);
    std::uint64_t touching = 0;
    for (const auto& [a, b] : listedPairs(simulation)) {
        const std::uint32_t ia = ids[a] & 0xffffffU;
        const std::uint32_t ib = ids[b] & 0xffffffU;
        const double reach = radiusOf(state, ia) + radiusOf(state, ib);
        if (glm::length(positionOf(state, ia) - positionOf(state, ib)) < reach * (1 + 1e-4)) ++touching;
    }
    return touching;
}

std::vector<SlotPair> pairsInOrder(sim::Simulation& simulation) {
    const auto words = simulation.pipeline().read<std::uint32_t>(sim::Array::Bundles);
    const auto pairs = simulation.pipeline().read<glm::uvec2>(sim::Array::Pairs);
    std::vector<SlotPair> found;
    for (std::size_t bundle = 0; bundle < simulation.plan().grid.bundles(); ++bundle) {
        const std::uint32_t first = words[bundle * BUNDLE_WORDS];
        const std::uint32_t listed = words[bundle * BUNDLE_WORDS + 1];
        for (std::uint32_t k = first; listed != UNLISTED && k < first + listed; ++k)
            if (SECOND_OF(pairs[k]) != simulation.plan().room)  // a pair that has ended: see movers.h
                found.emplace_back(pairs[k].x, SECOND_OF(pairs[k]));
    }
    return found;
}

std::vector<SlotPair> listedPairs(sim::Simulation& simulation) {
    std::vector<SlotPair> found = pairsInOrder(simulation);
    for (SlotPair& pair : found)
        if (pair.first > pair.second) std::swap(pair.first, pair.second);
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
