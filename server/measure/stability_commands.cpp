#include <cmath>

#include <fmt/format.h>

#include "measure/cases.h"
#include "measure/scenes.h"
#include "measure/stability.h"
#include "scene/random.h"

// Random commands to a running simulation, and a long time without commands.
namespace spherule::measure {

namespace {

scene::Scene smallBed() {
    scene::Scene scene = lattice(100, 0.05, 5);
    scene.bounds.open.fill(false);
    setFriction(scene, 0.3);
    return scene;
}

glm::dvec3 drawVector(scene::Random& random, double most) {
    glm::dvec3 vector{};
    for (int axis = 0; axis < 3; ++axis) vector[axis] = random.uniform(-most, most);
    return vector;
}

sim::Command drawCommand(scene::Random& random, std::uint32_t spheres) {
    switch (static_cast<int>(random.uniform(0, 7))) {
        case 0:
            return sim::Set{.gravity = drawVector(random, 20)};
        case 1:
            return sim::Set{.restitution = random.uniform()};
        case 2:
            return sim::Set{.friction = random.uniform(0, 2)};
        case 3:
            return sim::Set{.model = static_cast<scene::Model>(static_cast<int>(random.uniform(0, 3)))};
        case 4:
            return sim::Set{.substeps = static_cast<std::uint32_t>(random.uniform(1, 40))};
        case 5: {
            const auto sphere = static_cast<std::uint32_t>(random.uniform(0, spheres));
            return sim::Push{.target = sphere, .impulse = drawVector(random, 5)};
        }
        default:
            return sim::Reset();
    }
}

Result<void> randomCommands(Bench& bench) {
    auto opened = bench.open(smallBed());
    if (!opened) return tl::unexpected(opened.error());
    scene::Random random(3);
    const int commands = bench.quick() ? 30 : 200;
    int refused = 0;
    for (int k = 0; k < commands; ++k) {
        if (!(*opened)->apply(drawCommand(random, (*opened)->count()))) ++refused;
        for (int step = 0; step < 2; ++step)
            if (auto done = bench.step(**opened); !done) return done;
    }
    const sim::Statistics s = (*opened)->statistics();
    Figure figure = plain(fmt::format("after {} commands: fastest", commands), s.speedMax, "m/s");
    figure.verdict =
        s.nonFinite + s.outside == 0 ? "pass" : fmt::format("fails: {} not finite, {} outside", s.nonFinite, s.outside);
    bench.add(std::move(figure));
    bench.add(plain("commands refused", refused, ""));
    return {};
}

// A bed at rest must stay at rest.
Result<void> longRest(Bench& bench) {
    auto opened = bench.open(smallBed());
    if (!opened) return tl::unexpected(opened.error());
    sim::Simulation& simulation = **opened;
    if (auto done = bench.run(simulation, 2); !done) return done;
    const double height = simulation.statistics().meanHeight;
    const double seconds = bench.quick() ? 2 : 30;
    if (auto done = survive(bench, simulation, fmt::format("{:g} s at rest", seconds), seconds); !done) return done;
    const sim::Statistics s = simulation.statistics();
    Figure sunk = plain("sinking of the centre of mass", height - s.meanHeight, "m");
    constexpr double most = 0.001;
    sunk.verdict = std::abs(sunk.value) < most ? "pass" : fmt::format("fails: it moves by {:.3g} m", sunk.value);
    bench.add(std::move(sunk));
    bench.add(plain("rms speed at the end", s.speedRms, "m/s"));
    return {};
}

}  // namespace

std::vector<Case> commandCases() {
    return {{.suite = "stability", .name = "commands", .run = randomCommands, .everyRung = false},
            {.suite = "stability", .name = "long rest", .run = longRest, .everyRung = false}};
}

}  // namespace spherule::measure
