#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "measure/cases.h"
#include "measure/scenes.h"
#include "scene/shapes.h"

// Benchmarks 1 to 4 of Chung and Ooi 2011 (Granular Matter 13, 643).
namespace spherule::measure {

namespace {

constexpr double pi = std::numbers::pi;

const scene::Material glass{.name = "glass", .density = 2800, .restitution = 1, .young = 48e9, .poisson = 0.2};
const scene::Material limestone{.name = "limestone", .density = 2500, .restitution = 1, .young = 20e9, .poisson = 0.25};
const scene::Material aluminium{.name = "aluminium", .density = 2699, .restitution = 1, .young = 70e9, .poisson = 0.3};
const scene::Material magnesium{.name = "magnesium", .density = 1800, .restitution = 1, .young = 40e9, .poisson = 0.35};
const scene::Material rigid{.name = "rigid", .restitution = 1, .young = 1e18, .poisson = 0.2};
const scene::Material alumina{.name = "alumina", .density = 4000, .restitution = 1, .young = 380e9, .poisson = 0.23};

// An elastic impact under Hertz's law.
struct Hertz {
    double modulus = 0;  // Pa, effective
    double radius = 0;   // m, effective
    double mass = 0;     // kg, effective
    double speed = 0;    // approach speed, m/s

    [[nodiscard]] double force(double overlap) const {
        return overlap > 0 ? 4.0 / 3 * modulus * std::sqrt(radius) * std::pow(overlap, 1.5) : 0;
    }
    [[nodiscard]] double overlap() const {
        return std::pow(15 * mass * speed * speed / (16 * modulus * std::sqrt(radius)), 0.4);
    }
    [[nodiscard]] double time() const { return 2.943 * overlap() / speed; }
};

// Steps through the contact of sphere 0 with its neighbour in the direction +x, and adds figures.
Result<void> follow(Bench& bench, sim::Simulation& simulation, const Hertz& law, double reach, bool pair) {
    const double h = simulation.scene().step;
    const double mass = massOf(simulation.snapshot(), 0);
    double before = velocityOf(simulation.snapshot(), 0).x;
    double largest = 0;
    double strongest = 0;
    double deviation = 0;
    double began = -1;
    double ended = 0;
    const double limit = 4 * law.time();
    while (simulation.time() < limit) {
        if (auto done = bench.step(simulation); !done) return done;
        const sim::State state = simulation.snapshot();
        const double gap = pair ? positionOf(state, 1).x - positionOf(state, 0).x : -positionOf(state, 0).x;
        const double overlap = reach - gap;
        const double now = velocityOf(state, 0).x;
        const double force = mass * (before - now) / h;
        before = now;
        if (overlap <= 0) continue;
        const double speed = pair ? 2 * std::abs(now) : std::abs(now);
        if (began < 0) began = simulation.time() - overlap / law.speed;
        ended = simulation.time() + overlap / std::max(speed, 1e-9);
        largest = std::max(largest, overlap);
        strongest = std::max(strongest, force);
        deviation = std::max(deviation, std::abs(force - law.force(overlap)));
    }
    bench.add(against("largest overlap", largest, law.overlap(), "m"));
    bench.add(against("largest force", strongest, law.force(law.overlap()), "N"));
    bench.add(against("contact time", ended - began, law.time(), "s"));
    bench.add(against("force against overlap, worst", deviation, 0, "N", law.force(law.overlap())));
    return {};
}

double massOf(double radius, const scene::Material& material) {
    return 4.0 / 3 * pi * radius * radius * radius * material.density;
}

double modulusOf(const scene::Material& a, const scene::Material& b) {
    return 1 / ((1 - a.poisson * a.poisson) / a.young + (1 - b.poisson * b.poisson) / b.young);
}

// Benchmark 1: two equal spheres, R = 10 mm, at 10 m/s each.
Result<void> twoSpheres(Bench& bench, const scene::Material& material) {
    constexpr double r = 0.01;
    constexpr double v = 10;
    scene::Scene scene = openSpace(0.1);
    scene.materials = {material};
    scene.step = 1e-4;
    const Hertz law{modulusOf(material, material), r / 2, massOf(r, material) / 2, 2 * v};
    const double apart = r + 0.3 * v * law.time();
    addSphere(scene, {-apart, 0, 0}, r, {v, 0, 0});
    addSphere(scene, {apart, 0, 0}, r, {-v, 0, 0});
    auto opened = bench.openBySubstep(scene);
    if (!opened) return tl::unexpected(opened.error());
    return follow(bench, **opened, law, 2 * static_cast<double>(static_cast<float>(r)), true);
}

// Benchmark 2: a sphere, R = 0.1 m, hits a rigid wall at 0.2 m/s.
Result<void> sphereAtWall(Bench& bench, const scene::Material& material) {
    constexpr double r = 0.1;
    constexpr double v = 0.2;
    scene::Scene scene = openSpace(1);
    scene.materials = {material, rigid};
    scene.step = 1e-3;
    scene.obstacles.push_back({scene::planeShape({0, 0, 0}, {-1, 0, 0}), 1, ""});
    const Hertz law{modulusOf(material, rigid), r, massOf(r, material), v};
    addSphere(scene, {-r - 0.3 * v * law.time(), 0, 0}, r, {v, 0, 0});
    auto opened = bench.openBySubstep(scene);
    if (!opened) return tl::unexpected(opened.error());
    return follow(bench, **opened, law, static_cast<double>(static_cast<float>(r)), false);
}

// Benchmarks 3 and 4: the spheres of a scene hit the floor once.
constexpr double small = 0.0025;  // m, radius
constexpr double fast = 3.9;      // m/s

scene::Scene overFloor(const Bench& bench) {
    scene::Scene scene = openSpace(0.8);
    scene.bounds.open[scene::ZMin] = false;
    scene.bounds.min.z = -0.01;
    scene.bounds.max.z = 0.01;
    // An impact of real alumina takes 10 us, so steps must be short.
    scene.step = bench.accurate() ? 5e-4 : 1.0 / 60;
    return scene;
}

void throwAt(scene::Scene& scene, double along, double angle, std::uint8_t material) {
    const glm::dvec3 v = fast * glm::dvec3(std::sin(angle), 0, -std::cos(angle));
    addSphere(scene, {-0.1, along, scene.bounds.min.z + small - 2e-4 * v.z}, small, v, material);
}

Result<void> normalImpact(Bench& bench) {
    scene::Scene scene = overFloor(bench);
    scene.materials = {alumina};
    for (int k = 0; k <= 5; ++k) {
        scene::Material material = alumina;
        material.restitution = 0.2 * k;
        throwAt(scene, 0.02 * (k - 3), 0, addMaterial(scene, material));
    }
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    if (auto done = bench.run(**opened, std::max(scene.step, 1e-3)); !done) return done;
    const sim::State after = (*opened)->snapshot();
    for (std::uint32_t k = 0; k <= 5; ++k)
        bench.add(against(fmt::format("restitution {:.1f}", 0.2 * k), velocityOf(after, k).z / fast, 0.2 * k, "", 1));
    return {};
}

// Benchmark 4: impacts at an angle to the normal. The exact result is known if the sphere slides all the time.
Result<void> obliqueImpact(Bench& bench) {
    constexpr double mu = 0.092;
    constexpr double e = 0.98;
    constexpr std::array<double, 6> angles = {40, 45, 55, 60, 75, 85};
    scene::Scene scene = overFloor(bench);
    scene.materials = {alumina};
    scene.materials[0].restitution = e;
    scene.materials[0].friction = mu;
    for (std::size_t k = 0; k < angles.size(); ++k)
        throwAt(scene, 0.02 * (static_cast<double>(k) - 3), angles[k] * pi / 180, 0);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    if (auto done = bench.run(**opened, std::max(scene.step, 1e-3)); !done) return done;
    const sim::State after = (*opened)->snapshot();
    for (std::uint32_t k = 0; k < angles.size(); ++k) {
        const double angle = angles.at(k) * pi / 180;
        const glm::dvec3 v = velocityOf(after, k);
        const double kept = 1 - mu * (1 + e) / std::tan(angle);
        const std::string at = fmt::format(" at {:g} degrees", angles.at(k));
        const double spin = 2.5 * mu * (1 + e) * fast * std::cos(angle) / small;
        const double rebound = std::atan2(kept * std::sin(angle), e * std::cos(angle)) * 180 / pi;
        bench.add(against("tangential restitution" + at, v.x / (fast * std::sin(angle)), kept, ""));
        bench.add(against("spin" + at, std::abs(spinOf(after, k).y), spin, "rad/s"));
        bench.add(against("rebound angle" + at, std::atan2(v.x, v.z) * 180 / pi, rebound, "degrees"));
    }
    return {};
}

}  // namespace

std::vector<Case> hertzCases() {
    return {{.suite = "accuracy",
             .name = "Chung & Ooi 1, glass",
             .run = [](Bench& bench) { return twoSpheres(bench, glass); },
             .everyModel = false},
            {.suite = "accuracy",
             .name = "Chung & Ooi 1, limestone",
             .run = [](Bench& bench) { return twoSpheres(bench, limestone); },
             .everyModel = false},
            {.suite = "accuracy",
             .name = "Chung & Ooi 2, aluminium",
             .run = [](Bench& bench) { return sphereAtWall(bench, aluminium); },
             .everyModel = false},
            {.suite = "accuracy",
             .name = "Chung & Ooi 2, magnesium",
             .run = [](Bench& bench) { return sphereAtWall(bench, magnesium); },
             .everyModel = false},
            {.suite = "accuracy", .name = "Chung & Ooi 3", .run = normalImpact},
            {.suite = "accuracy", .name = "Chung & Ooi 4", .run = obliqueImpact}};
}

}  // namespace spherule::measure
