#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "measure/cases.h"
#include "measure/scenes.h"

// The slope of the pile that remains of a collapsed column.
namespace spherule::measure {

namespace {

constexpr double r = 0.05;

// Returns the slope of the pile (degrees). It is fitted to the highest sphere of each ring around the middle, from the
// crest to the first ring with a single layer. A ring is as wide as a diameter.
double slopeOf(const sim::State& state, double floor) {
    constexpr std::size_t most = 40;
    std::array<double, most> tops{};
    glm::dvec3 middle{};
    for (std::uint32_t id = 0; id < state.count(); ++id)
        middle += positionOf(state, id) / static_cast<double>(state.count());
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const glm::dvec3 d = positionOf(state, id) - middle;
        const auto ring = static_cast<std::size_t>(std::hypot(d.x, d.y) / (2 * r));
        if (ring < most) tops.at(ring) = std::max(tops.at(ring), positionOf(state, id).z - floor);
    }
    double count = 0;
    double x = 0;
    double z = 0;
    double xx = 0;
    double xz = 0;
    for (std::size_t ring = 0; ring < most && tops.at(ring) > 1.5 * r; ++ring) {
        const double at = (static_cast<double>(ring) + 0.5) * 2 * r;
        count += 1;
        x += at;
        z += tops.at(ring);
        xx += at * at;
        xz += at * tops.at(ring);
    }
    if (count < 2) return 0;
    return -std::atan((count * xz - x * z) / (count * xx - x * x)) * 180 / std::numbers::pi;
}

Result<void> repose(Bench& bench) {
    for (const double friction : {0.1, 0.3, 0.6}) {
        scene::Scene scene = lattice(600, r, 8.1);
        scene.bounds.min = {-4, -4, scene.bounds.min.z};
        scene.bounds.max = {4, 4, scene.bounds.max.z};
        scene.bounds.open.fill(true);
        scene.bounds.open[scene::ZMin] = false;
        setFriction(scene, friction);
        // Without rolling resistance, spheres on a flat floor roll away one by one.
        scene.materials[0].rollingResistance = 0.1;
        auto opened = bench.open(scene);
        if (!opened) return tl::unexpected(opened.error());
        if (auto done = bench.run(**opened, 3); !done) return done;
        const double slope = slopeOf((*opened)->snapshot(), scene.bounds.min.z);
        // The slope of a collapsed column follows no law. The slope of poured piles is about atan(friction).
        bench.add(plain(fmt::format("slope with friction {:g}", friction), slope, "degrees"));
    }
    return {};
}

}  // namespace

std::vector<Case> reposeCases() {
    return {{.suite = "accuracy",
             .name = "slope of a fallen column",
             .run = repose,
             .everyRung = false,
             .whenQuick = false}};
}

}  // namespace spherule::measure
