#include "trajectories.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scene/load.h"
#include "sim/simulation.h"

namespace spherule::bench {

namespace {

constexpr double fullCount = 50'000;
constexpr double width = 1.6;     // m, of the box
constexpr double height = 5;      // m
constexpr double margin = 0.2;    // m, between the column and the walls
constexpr double spacing = 0.05;  // m
constexpr double radius = 0.02;   // m
constexpr double spread = 0.2;    // of the radius
constexpr double earth = 9.81;    // m/s^2
constexpr unsigned stepsPerFrame = 2;

void set(google::protobuf::RepeatedField<double>* field, glm::dvec3 value) {
    for (int axis = 0; axis < 3; ++axis) field->Add(value[axis]);
}

scene::Scene column(std::uint32_t spheres, bool sleep) {
    const double scale = std::cbrt(spheres / fullCount);
    const double side = width * scale;
    v1::Scene message;
    message.set_name("column");
    v1::Material& material = *message.add_materials();
    material.set_restitution(0.5);
    material.set_friction(0.3);
    set(message.mutable_bounds()->mutable_min(), {0, 0, 0});
    set(message.mutable_bounds()->mutable_max(), {side, side, height * scale + spacing});
    message.mutable_bounds()->add_open(v1::Z_MAX);
    v1::Group& group = *message.add_groups();
    group.mutable_radius()->mutable_uniform()->set_min(radius * (1 - spread));
    group.mutable_radius()->mutable_uniform()->set_max(radius * (1 + spread));
    v1::Lattice& lattice = *group.mutable_lattice();
    set(lattice.mutable_min(), {margin * scale, margin * scale, 0});
    set(lattice.mutable_max(), {side - margin * scale, side - margin * scale, height * scale + spacing});
    lattice.set_spacing(spacing);
    lattice.set_jitter(0.0005);
    lattice.set_count(spheres);
    lattice.set_seed(1);
    auto built = scene::build(message, {.noSleep = !sleep});
    if (!built) throw std::runtime_error(built.error().text());
    return std::move(*built);
}

// Gravity tilts by 30 degrees within 0.8 s while it turns once in 4 s.
glm::dvec3 stirring(double time) {
    const double tilt = std::numbers::pi / 6 * std::min(1.0, time / 0.8);
    const double turn = std::numbers::pi / 2 * time;
    return earth * glm::dvec3(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
}

std::unique_ptr<sim::Simulation> simulate(compute::Device& device, scene::Scene scene) {
    auto made = sim::Simulation::create(device, std::move(scene));
    if (!made) throw std::runtime_error(made.error().text());
    return std::move(*made);
}

void advance(sim::Simulation& simulation, unsigned frames) {
    for (unsigned k = 0; k < frames * stepsPerFrame; ++k)
        if (auto done = simulation.step(); !done) throw std::runtime_error(done.error().text());
}

void record(sim::Simulation& simulation, Trajectory& into) {
    const sim::State state = simulation.snapshot();
    into.frames.emplace_back(state.position.begin(), state.position.end());
}

Trajectory named(const char* name, std::uint32_t spheres) {
    return {.name = name, .spheres = spheres, .smallestRadius = radius * (1 - spread), .frames = {}};
}

}  // namespace

std::vector<Trajectory> collapse(compute::Device& device, std::uint32_t spheres) {
    Trajectory moving = named("moving", spheres);
    Trajectory settled = named("settled", spheres);
    Trajectory stirred = named("stirred", spheres);
    Trajectory asleep = named("asleep", spheres);
    auto simulation = simulate(device, column(spheres, false));
    advance(*simulation, 6);
    for (unsigned k = 6; k < 42; ++k) {
        record(*simulation, moving);
        advance(*simulation, 1);
    }
    advance(*simulation, 120 - 42);
    for (unsigned k = 120; k < 180; ++k) {
        record(*simulation, settled);
        advance(*simulation, 1);
    }
    const sim::State bed = simulation->snapshot();
    for (unsigned k = 180; k < 240; ++k) {
        const glm::dvec3 gravity = stirring((k - 180) / framesPerSecond);
        if (auto done = simulation->apply(sim::Set{.gravity = gravity}); !done)
            throw std::runtime_error(done.error().text());
        if (k >= 192) record(*simulation, stirred);
        advance(*simulation, 1);
    }
    simulation = simulate(device, column(spheres, true));
    simulation->upload(bed);
    advance(*simulation, 150);
    for (unsigned k = 0; k < 30; ++k) {
        record(*simulation, asleep);
        advance(*simulation, 1);
    }
    return {std::move(moving), std::move(stirred), std::move(settled), std::move(asleep)};
}

}  // namespace spherule::bench
