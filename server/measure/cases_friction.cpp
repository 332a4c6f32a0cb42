#include <cmath>

#include <glm/geometric.hpp>

#include "measure/cases.h"
#include "measure/scenes.h"

// One sphere on a floor with friction.
namespace spherule::measure {

namespace {

constexpr double r = 0.05;

// Sphere 0 lies on the floor at the left. Gravity is tilted by `slope` (radians) towards +x.
scene::Scene onFloor(double friction, double slope, double speed) {
    scene::Scene scene = openSpace(8);
    scene.bounds.min.z = -0.5;
    scene.bounds.max.z = 0.5;
    scene.bounds.open[scene::ZMin] = false;
    scene.forces.gravity = earth * glm::dvec3(std::sin(slope), 0, -std::cos(slope));
    setRestitution(scene, 0);
    setFriction(scene, friction);
    addSphere(scene, {-3, 0, -0.5 + r}, r, {speed, 0, 0});
    return scene;
}

Result<void> slipToRoll(Bench& bench) {
    constexpr double u0 = 2;
    constexpr double mu = 0.3;
    constexpr double duration = 0.5;
    auto opened = bench.open(onFloor(mu, 0, u0));
    if (!opened) return tl::unexpected(opened.error());
    const double start = positionOf((*opened)->snapshot(), 0).x;
    if (auto done = bench.run(**opened, duration); !done) return done;
    const sim::State after = (*opened)->snapshot();
    const double u = velocityOf(after, 0).x;
    // Soft spheres overlap the floor a little, and rotate about the contact point.
    const double arm = positionOf(after, 0).z + 0.5;
    const double inertia = 2.5 * arm * arm / (r * r);
    // The speed falls linearly until the sphere rolls. So the distance beyond final speed * time follows from the
    // duration of the slip: it is half of (initial speed - final speed) * duration.
    const double way = positionOf(after, 0).x - start;
    const double slipped = 2 * (way - u * (*opened)->time()) / (u0 - u);
    Figure time = against("time until it rolls", slipped, u0 / ((1 + inertia) * mu * earth), "s");
    time.curve = "slip to roll";
    bench.add(time);
    bench.add(against("speed then", u, inertia / (1 + inertia) * u0, "m/s"));
    bench.add(against("spin times arm over speed", spinOf(after, 0).y * arm / u, 1, ""));
    return {};
}

// Returns the acceleration down the slope (m/s^2), after the motion has become steady.
Result<double> acceleration(Bench& bench, const scene::Scene& scene) {
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    const double settle = bench.quick() ? 0.1 : 0.3;
    const double watch = bench.quick() ? 0.1 : 0.5;
    if (auto done = bench.run(**opened, settle); !done) return tl::unexpected(done.error());
    const double before = velocityOf((*opened)->snapshot(), 0).x;
    const double began = (*opened)->time();
    if (auto done = bench.run(**opened, watch); !done) return tl::unexpected(done.error());
    return (velocityOf((*opened)->snapshot(), 0).x - before) / ((*opened)->time() - began);
}

Result<void> incline(Bench& bench) {
    const double gentle = std::atan(0.3);
    const double steep = std::atan(0.8);
    constexpr double slippery = 0.1;
    const auto rolling = acceleration(bench, onFloor(0.3, gentle, 0));
    if (!rolling) return tl::unexpected(rolling.error());
    bench.add(against("acceleration, rolling", *rolling, 5.0 / 7 * earth * std::sin(gentle), "m/s^2"));
    const auto sliding = acceleration(bench, onFloor(slippery, steep, 0));
    if (!sliding) return tl::unexpected(sliding.error());
    const double expected = earth * (std::sin(steep) - slippery * std::cos(steep));
    bench.add(against("acceleration, sliding", *sliding, expected, "m/s^2"));
    return {};
}

Result<void> rollingResistance(Bench& bench) {
    constexpr double resistance = 0.05;
    constexpr double speed = 1;
    scene::Scene scene = onFloor(0.5, 0, speed);
    scene.materials[0].rollingResistance = resistance;
    scene.spheres[0].spin = {0, static_cast<float>(speed / r), 0};
    const auto slowing = acceleration(bench, scene);
    if (!slowing) return tl::unexpected(slowing.error());
    bench.add(against("slowing down", -*slowing, 5.0 / 7 * resistance * earth, "m/s^2"));
    return {};
}

}  // namespace

std::vector<Case> frictionCases() {
    return {{.suite = "accuracy", .name = "slip to roll", .run = slipToRoll},
            {.suite = "accuracy", .name = "incline", .run = incline},
            {.suite = "accuracy", .name = "rolling resistance", .run = rollingResistance}};
}

}  // namespace spherule::measure
