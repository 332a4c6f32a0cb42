#include "sim/relax.h"

#include <cmath>
#include <limits>

#include "scene/stiffness.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

constexpr std::uint32_t mostSweeps = 1024;
constexpr std::uint32_t sweepsPerLook = 16;

// In `fast`, where pushing makes no speed.
scene::Scene withoutForces(const scene::Scene& scene) {
    scene::Scene still = scene;
    still.gravity = {};
    still.sleep.enabled = false;
    still.step = 1.0 / 480;
    still.quality = {.model = scene::Model::Fast, .substeps = 1, .pinned = true};
    still.pairs.clear();
    for (scene::Material& material : still.materials)
        material = {.name = material.name, .density = material.density, .restitution = 0};
    return still;
}

State atRest(State state) {
    for (glm::vec4& velocity : state.velocity) velocity = glm::vec4(0, 0, 0, std::abs(velocity.w));
    for (glm::vec4& spin : state.spin) spin = {};
    return state;
}

}  // namespace

double deepestBearable(const scene::Scene& scene) {
    constexpr double shallow = 0.25;  // in beds that are squeezed, but not in spheres put in each other
    if (scene.quality.model == scene::Model::Fast) return std::numeric_limits<double>::infinity();
    if (scene.quality.model == scene::Model::Balanced) return shallow;
    return scene::contactTimeOf(scene).overlap;
}

Result<Relaxed> relax(compute::Device& device, const scene::Scene& scene, const State& state, double most) {
    auto made = Simulation::create(device, withoutForces(scene));
    if (!made) return tl::unexpected(made.error());
    Simulation& world = **made;
    Relaxed relaxed{.state = state};
    world.put(atRest(state));
    do {
        for (std::uint32_t k = 0; k < sweepsPerLook; ++k)
            if (auto done = world.step(); !done) return tl::unexpected(done.error());
        relaxed.sweeps += sweepsPerLook;
        relaxed.overlap = world.statistics().deepest();
    } while (relaxed.overlap > most && relaxed.sweeps < mostSweeps);
    relaxed.state.position = world.snapshot().position;
    return relaxed;
}

}  // namespace spherule::sim
