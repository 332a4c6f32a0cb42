#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "measure/cases.h"
#include "measure/scenes.h"

// Pairs of spheres that collide once, many of them side by side.
namespace spherule::measure {

namespace {

constexpr std::array<double, 6> restitutions = {0, 0.3, 0.5, 0.8, 0.9, 1};

// Soft spheres get fewer ratios, because their contact time is proportional to the square root of the lightest mass.
std::vector<double> massRatios(const Bench& bench) {
    std::vector<double> ratios = {1, 10};
    if (!bench.quick()) ratios.push_back(1e3);
    if (!bench.accurate()) ratios.push_back(1e6);
    return ratios;
}

struct Meeting {
    double restitution = 0;
    double massRatio = 0;
};

// Adds a pair for each restitution and mass ratio. The second sphere is `aside` radii off the path of the first.
std::vector<Meeting> addMeetings(const Bench& bench, scene::Scene& scene, double aside) {
    constexpr double r = 0.05;
    std::vector<Meeting> meetings;
    double lane = -3;
    for (const double e : restitutions) {
        for (const double ratio : massRatios(bench)) {
            const auto light = addMaterial(scene, {.density = 1000, .restitution = e});
            const auto heavy = addMaterial(scene, {.density = 1000 * ratio, .restitution = e});
            addSphere(scene, {-0.11, lane, 0}, r, {1.5, 0, 0}, heavy);
            addSphere(scene, {0.03, lane, aside * r}, r, {-0.5, 0, 0}, light);
            meetings.push_back({e, ratio});
            lane += 0.25;
        }
    }
    return meetings;
}

struct Parting {
    double restitution = 0;
    glm::dvec3 normal{};  // direction of the impulse, unit length
};

Parting partingOf(const sim::State& before, const sim::State& after, std::uint32_t heavy) {
    const std::uint32_t light = heavy + 1;
    const glm::dvec3 in = velocityOf(before, heavy) - velocityOf(before, light);
    const glm::dvec3 out = velocityOf(after, heavy) - velocityOf(after, light);
    const glm::dvec3 change = velocityOf(after, light) - velocityOf(before, light);
    const glm::dvec3 n = glm::length(change) > 0 ? glm::normalize(change) : glm::dvec3(1, 0, 0);
    return {-glm::dot(out, n) / glm::dot(in, n), n};
}

Result<void> meet(Bench& bench, double aside, const char* curve) {
    scene::Scene scene = openSpace(8);
    const std::vector<Meeting> meetings = addMeetings(bench, scene, aside);
    auto opened = bench.open(scene);
    if (!opened) return tl::unexpected(opened.error());
    const sim::State before = (*opened)->snapshot();
    if (auto done = bench.run(**opened, 0.1); !done) return done;
    const sim::State after = (*opened)->snapshot();
    Figure worst;
    double drift = 0;
    double turned = 0;
    for (std::uint32_t k = 0; k < meetings.size(); ++k) {
        const Parting parting = partingOf(before, after, 2 * k);
        const double e = meetings[k].restitution;
        const Figure figure = against(fmt::format("restitution {:g}, masses 1 : {:g}", e, meetings[k].massRatio),
                                      parting.restitution, e, "", 1);
        if (k == 0 || *figure.error > *worst.error) worst = figure;
        bench.add(figure);
        const glm::dvec3 gained =
            massOf(before, 2 * k) * (velocityOf(after, 2 * k) - velocityOf(before, 2 * k)) +
            massOf(before, 2 * k + 1) * (velocityOf(after, 2 * k + 1) - velocityOf(before, 2 * k + 1));
        // The momentum of the light sphere changes by its mass times about 1.5 m/s. The drift is relative to this.
        drift = std::max(drift, glm::length(gained) / (massOf(before, 2 * k) * 1.5));
        // The angle of the line of centres is only exact to the distance that a sphere moves in a substep.
        const double off = std::acos(std::clamp(parting.normal.x, -1.0, 1.0)) - std::asin(aside / 2);
        turned = std::max(turned, std::abs(off));
    }
    worst.name = "worst restitution";
    worst.curve = curve;
    bench.add(worst);
    bench.add(against("momentum gained over that put in", drift, 0, "", 1));
    bench.add(against("direction of the push, worst", turned, 0, "rad", 1));
    return {};
}

Result<void> headOn(Bench& bench) {
    return meet(bench, 0, "restitution");
}

Result<void> oblique(Bench& bench) {
    return meet(bench, 1, "");
}

}  // namespace

std::vector<Case> impactCases() {
    return {{.suite = "accuracy", .name = "head-on", .run = headOn},
            {.suite = "accuracy", .name = "oblique", .run = oblique}};
}

}  // namespace spherule::measure
