#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "measure/cases.h"
#include "measure/scenes.h"

// One sphere in free flight, and one that bounces on a floor.
namespace spherule::measure {

namespace {

Result<void> projectile(Bench& bench) {
    scene::Scene scene = openSpace(8);
    scene.forces.gravity = {0, 0, -earth};
    const glm::dvec3 start(-2, 0.1, -1);
    const glm::dvec3 thrown(3, 1, 5);
    addSphere(scene, start, 0.05, thrown);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    constexpr double duration = 1;
    if (auto done = bench.run(**opened, duration); !done) return done;
    const glm::dvec3 expected = start + duration * thrown + 0.5 * duration * duration * scene.forces.gravity;
    const glm::dvec3 off = positionOf((*opened)->snapshot(), 0) - expected;
    bench.add(against("distance from the parabola", glm::length(off), 0, "m", glm::length(expected - start)));
    return {};
}

struct Apex {
    double time = 0;    // s
    double height = 0;  // m above the lowest possible position of the centre
};

// Returns the first `count` apexes of the only sphere. Each follows from the sphere's speed in the step of the apex.
Result<std::vector<Apex>> apexes(Bench& bench, sim::Simulation& simulation, std::size_t count) {
    const double g = -simulation.scene().forces.gravity.z;
    const double floor = simulation.scene().bounds.min.z;
    std::vector<Apex> found;
    bool rising = false;
    for (int step = 0; step < 600 && found.size() < count; ++step) {
        if (auto done = bench.step(simulation); !done) return tl::unexpected(done.error());
        const sim::State state = simulation.snapshot();
        const double speed = velocityOf(state, 0).z;
        if (rising && speed <= 0)
            found.push_back({simulation.time() + speed / g,
                             positionOf(state, 0).z - floor - radiusOf(state, 0) + speed * speed / (2 * g)});
        rising = speed > 0;
    }
    return found;
}

Result<void> bounce(Bench& bench) {
    constexpr double height = 1;
    constexpr double e = 0.8;
    scene::Scene scene = closedBox(2.4);
    scene.bounds.open[scene::ZMax] = true;
    setRestitution(scene, e);
    addSphere(scene, {0, 0, -1.2 + 0.05 + height}, 0.05);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    const auto found = apexes(bench, **opened, 5);
    if (!found) return tl::unexpected(found.error());
    if (found->size() < 5) return fail(ErrorKind::Refused, "", "the sphere stopped before its fifth apex");
    const double fall = std::sqrt(2 * height / earth);
    double expected = height;
    double time = fall;
    double factor = e;
    Figure worst = plain("worst apex", 0, "m");
    for (std::size_t k = 0; k < found->size(); ++k) {
        expected *= e * e;
        const std::string name = "apex " + std::to_string(k + 1);
        const Figure figure = against(name, (*found)[k].height, expected, "m");
        if (*figure.error >= worst.error.value_or(0)) worst = figure;
        bench.add(figure);
        time += factor * fall;
        bench.add(against("time of " + name, (*found)[k].time, time, "s"));
        time += factor * fall;
        factor *= e;
    }
    worst.name = "worst apex";
    worst.curve = "bounce apex";
    bench.add(worst);
    return {};
}

}  // namespace

std::vector<Case> flightCases() {
    return {{.suite = "accuracy", .name = "projectile", .run = projectile},
            {.suite = "accuracy", .name = "bounce", .run = bounce}};
}

}  // namespace spherule::measure
