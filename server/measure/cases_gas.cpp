#include <cmath>

#include <glm/geometric.hpp>

#include "measure/cases.h"
#include "measure/scenes.h"
#include "scene/random.h"

namespace spherule::measure {

namespace {

// Elastic spheres of three radii collide in open space.
Result<void> gas(Bench& bench) {
    const int side = bench.quick() ? 6 : 10;
    constexpr double pitch = 0.13;
    scene::Scene scene = openSpace(20);
    setRestitution(scene, 1);
    scene::Random random(2);
    for (int k = 0; k < side * side * side; ++k) {
        const glm::dvec3 place = glm::dvec3(k % side, k / side % side, k / side / side) - 0.5 * (side - 1);
        const double x = random.normal();
        const double y = random.normal();
        const double z = random.normal();
        addSphere(scene, pitch * place, 0.04 + 0.01 * (k % 3), glm::dvec3(x, y, z) - 2.0 * pitch * place);
    }
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    const sim::State before = (*opened)->snapshot();
    const glm::dvec3 angular = (*opened)->statistics().angularMomentum;
    bench.startClock();
    if (auto done = bench.run(**opened, 0.5); !done) return done;
    const sim::State after = (*opened)->snapshot();
    const double momentum = glm::length(momentumOf(after) - momentumOf(before)) / momentumScale(before);
    bench.add(against("momentum gained over the sum of m |v|", momentum, 0, "", 1));
    bench.add(against("energy over that put in", kineticEnergyOf(after) / kineticEnergyOf(before), 1, ""));
    const double turned = glm::length((*opened)->statistics().angularMomentum - angular);
    bench.add(
        against("angular momentum gained over the sum of m |v| times 1 m", turned / momentumScale(before), 0, "", 1));
    return {};
}

}  // namespace

std::vector<Case> gasCases() {
    return {{.suite = "accuracy", .name = "elastic gas", .run = gas}};
}

}  // namespace spherule::measure
