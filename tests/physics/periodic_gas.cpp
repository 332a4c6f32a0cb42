#include "periodic_gas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <glm/geometric.hpp>

#include "scene/quality.h"
#include "scene/random.h"
#include "support.h"

namespace spherule::physics {

namespace {

// The impulses of one substep, found from the changes of velocity. In a substep few spheres meet, nearly always in
// chains. The sphere at the end of a chain has met only one other, so that its change is the impulse of that pair. The
// search goes on from the ends.
class Impulses {
  public:
    Impulses(const sim::State& before, const sim::State& after, const glm::dvec3& periods, double reach)
        : after_(after), periods_(periods), left_(after.count()) {
        for (std::uint32_t id = 0; id < after.count(); ++id) {
            left_[id] = massOf(after, id) * (velocityOf(after, id) - velocityOf(before, id));
            if (left_[id] != glm::dvec3(0)) changed_.push_back(id);
        }
        for (std::size_t a = 0; a < changed_.size(); ++a)
            for (std::size_t b = a + 1; b < changed_.size(); ++b)
                if (glm::length(between(changed_[a], changed_[b])) < reach)
                    links_.push_back({changed_[a], changed_[b]});
    }

    // Returns the sum of distance times impulse over the pairs.
    double virial() {
        double sum = 0;
        while (!links_.empty()) {
            std::vector<int> partners(after_.count());
            for (const auto& link : links_)
                for (const std::uint32_t id : link) ++partners[id];
            // The end of a chain; any pair of a ring.
            auto end = std::ranges::find_if(
                links_, [&](const auto& link) { return partners[link[0]] == 1 || partners[link[1]] == 1; });
            if (end == links_.end()) end = links_.begin();
            const auto [a, b] = *end;
            links_.erase(end);
            const bool first = partners[a] == 1;
            const glm::dvec3 impulse = first ? left_[a] : -left_[b];  // on a
            left_[a] -= impulse;
            left_[b] += impulse;
            sum += glm::dot(between(a, b), impulse);
        }
        return sum;
    }

  private:
    [[nodiscard]] glm::dvec3 between(std::uint32_t a, std::uint32_t b) const {
        return scene::separation(positionOf(after_, a), positionOf(after_, b), periods_);
    }

    const sim::State& after_;
    glm::dvec3 periods_;
    std::vector<glm::dvec3> left_;  // N s, by id
    std::vector<std::uint32_t> changed_;
    std::vector<std::array<std::uint32_t, 2>> links_;
};

double twiceEnergyOf(const sim::State& state) {
    double sum = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id)
        sum += massOf(state, id) * glm::dot(velocityOf(state, id), velocityOf(state, id));
    return sum;
}

}  // namespace

scene::Scene periodicGas(const PeriodicGasOf& gas, std::uint64_t seed) {
    const double ball = 4.0 / 3.0 * std::numbers::pi * std::pow(gasRadius, 3);
    const double side = std::cbrt(gas.count * ball / gas.fraction);
    scene::Scene scene = measure::openSpace(side);
    scene.bounds.open.fill(false);
    scene.bounds.periodic.fill(true);
    setRestitution(scene, 1);
    const auto cubes = static_cast<std::uint32_t>(std::ceil(std::cbrt(gas.count / 4.0) - 1e-9));
    const double pitch = side / cubes;
    constexpr std::array<glm::dvec3, 4> places = {{{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};
    scene::Random random(seed);
    glm::dvec3 sum(0);
    for (std::uint32_t k = 0; k < gas.count; ++k) {
        const std::uint32_t cube = k / 4;
        const glm::dvec3 corner(cube % cubes, cube / cubes % cubes, cube / (cubes * cubes));
        const glm::dvec3 velocity = gas.spread * glm::dvec3(random.normal(), random.normal(), random.normal());
        const double radius = gas.ratio > 1 ? random.uniform(gasRadius / gas.ratio, gasRadius) : gasRadius;
        measure::addSphere(scene, -side / 2 + pitch * (corner + places.at(k % 4)), radius, velocity);
        sum += velocity;
    }
    for (scene::Sphere& sphere : scene.spheres) sphere.velocity -= glm::vec3(sum / static_cast<double>(gas.count));
    return scene;
}

double sideOf(const scene::Scene& scene) {
    return scene.bounds.max.x - scene.bounds.min.x;
}

void chooseModel(scene::Scene& scene, scene::Model model, double overlap) {
    scene.quality = {.model = model, .substepsFixed = false, .overlap = overlap};
    scene.quality.substeps = static_cast<std::uint32_t>(scene::defaultSubsteps(scene));
}

double carnahanStarling(double fraction) {
    return (1 + fraction + fraction * fraction - std::pow(fraction, 3)) / std::pow(1 - fraction, 3);
}

GasPressure pressureOf(scene::Model model, double fraction, std::uint32_t count, std::uint64_t seed, double impacts) {
    // Slow enough for a sphere to meet one other in a substep.
    constexpr double spread = 0.1;
    scene::Scene scene = periodicGas({.count = count, .fraction = fraction, .spread = spread}, seed);
    chooseModel(scene, model, 0.015);
    const double mass = 4.0 / 3 * std::numbers::pi * std::pow(gasRadius, 3) * scene.materials.front().density;
    const auto simulation = simulate(scene);
    // The lattice melts.
    run(*simulation, 0.03 / (fraction * spread));
    GasPressure found;
    double virial = 0;
    double seconds = 0;
    double energies = 0;
    double readings = 0;
    // Impulses of a Maxwell distribution: their mean gives the number of impacts.
    const double meanImpulse = mass * spread * std::sqrt(std::numbers::pi);
    sim::State before = simulation->snapshot();
    while (found.impacts < impacts) {
        if (auto done = simulation->advance(); !done) throw std::runtime_error(done.error().text());
        sim::State after = simulation->snapshot();
        const double added = Impulses(before, after, scene.bounds.periods(), 2.2 * gasRadius).virial();
        virial += added;
        found.impacts += added / (2 * gasRadius * meanImpulse);
        energies += twiceEnergyOf(after);
        readings += 1;
        seconds += scene.step / simulation->substeps();
        before = std::move(after);
    }
    // The centre of mass is at rest: N - 1 spheres move freely.
    const double kinetic = energies / readings * count / (count - 1.0);
    found.compressibility = 1 + virial / seconds / kinetic;
    return found;
}

GasFlux fluxOf(scene::Model model, std::uint32_t count, std::uint64_t seed, std::uint64_t crossings) {
    scene::Scene scene = periodicGas({.count = count, .fraction = 0.1, .spread = 0.5}, seed);
    chooseModel(scene, model, 0.1);
    const auto simulation = simulate(scene);
    run(*simulation, 0.5);
    GasFlux found;
    double speeds = 0;
    double seconds = 0;
    double readings = 0;
    sim::State before = simulation->snapshot();
    while (found.crossings < crossings) {
        if (auto done = simulation->advance(); !done) throw std::runtime_error(done.error().text());
        sim::State after = simulation->snapshot();
        for (std::uint32_t id = 0; id < count; ++id) {
            for (int axis = 0; axis < 3; ++axis)
                found.crossings +=
                    static_cast<std::uint64_t>(std::abs(after.images[id][axis] - before.images[id][axis]));
            speeds += glm::length(velocityOf(after, id));
        }
        seconds += scene.step / simulation->substeps();
        readings += 1;
        before = std::move(after);
    }
    const double side = sideOf(scene);
    // Three seams, two ways.
    found.measured = static_cast<double>(found.crossings) / (6 * side * side * seconds);
    found.expected = speeds / readings / std::pow(side, 3) / 4;
    return found;
}

}  // namespace spherule::physics
