#include "sim/radius_stats.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "sim/layout.h"

namespace spherule::sim {

namespace {

constexpr int mostBins = 12;
constexpr double narrowestBin = std::numbers::sqrt2;
constexpr double ball = 4.0 / 3 * std::numbers::pi;

// Returns bins of spheres of similar size, from the smallest to the largest. Classes are made of bins.
std::vector<SizeClass> binsOf(const scene::Scene& scene, const RadiusStats& radii) {
    const double range = std::log(radii.largest / radii.smallest);
    const double wide = std::max(std::log(narrowestBin), range / mostBins);
    std::vector<SizeClass> bins(mostBins);
    std::vector<double> spheres(mostBins);
    scene::forEachSphere(scene, [&](const scene::Sphere& sphere, double weight) {
        const auto r = static_cast<double>(sphere.radius);
        const auto place = static_cast<std::size_t>(
            std::clamp(static_cast<int>(std::log(r / radii.smallest) / wide), 0, mostBins - 1));
        SizeClass& mine = bins[place];
        mine.smallest = spheres[place] == 0 ? r : std::min(mine.smallest, r);
        mine.largest = std::max(mine.largest, r);
        spheres[place] += weight;
    });
    for (std::size_t k = 0; k < bins.size(); ++k) bins[k].spheres = static_cast<std::uint32_t>(std::ceil(spheres[k]));
    std::erase_if(bins, [](const SizeClass& one) { return one.spheres == 0; });
    return bins;
}

// Joins successive bins to classes. Bit k of `cuts` is set if bin k + 1 begins a new class.
std::vector<SizeClass> joined(const std::vector<SizeClass>& bins, std::uint32_t cuts) {
    std::vector<SizeClass> classes{bins.front()};
    for (std::size_t k = 1; k < bins.size(); ++k) {
        if ((cuts >> (k - 1) & 1U) != 0) {
            classes.push_back(bins[k]);
            continue;
        }
        classes.back().largest = bins[k].largest;
        classes.back().spheres += bins[k].spheres;
    }
    return classes;
}

// Returns the cost of building the lists of a dense bed, in tests of pairs. Spheres are tested against their own class,
// and against the cells of finer classes row by row. The weights were fitted to timings of beds on the CPU device.
double costOf(const std::vector<SizeClass>& classes, double volume, double margin) {
    constexpr double rowCost = 25;
    constexpr double reachCost = 25;
    constexpr double levelCost = 4000;  // its own launches
    constexpr double neighbours = 14;
    double cost = 0;
    for (std::size_t coarse = 0; coarse < classes.size(); ++coarse) {
        const SizeClass& large = classes[coarse];
        const double own = 2 * large.largest + margin;
        double perSphere = neighbours * large.spheres * own * own * own / volume;
        const double r = 0.5 * (large.smallest + large.largest);
        for (std::size_t fine = 0; fine < coarse; ++fine) {
            const SizeClass& small = classes[fine];
            const double cell = 2 * small.largest + margin;
            const double reach = r + small.largest + margin;
            const double rows = std::numbers::pi * std::pow(reach / cell + 0.7, 2);
            const double shell = ball * (std::pow(reach + 0.6 * cell, 3) - std::pow(r, 3));
            perSphere += reachCost + rowCost * rows + shell * small.spheres / volume;
        }
        cost += levelCost + large.spheres * perSphere;
    }
    return cost;
}

// Returns the division of the bins into classes that costs least.
std::vector<SizeClass> classesOf(const scene::Scene& scene, const RadiusStats& radii, double volume) {
    const std::vector<SizeClass> bins = binsOf(scene, radii);
    std::vector<SizeClass> best = joined(bins, 0);
    double least = costOf(best, volume, radii.mean * typicalMarginInRadii);
    for (std::uint32_t cuts = 1; cuts < 1U << (bins.size() - 1); ++cuts) {
        if (std::popcount(cuts) >= static_cast<int>(MOST_LEVELS)) continue;
        std::vector<SizeClass> classes = joined(bins, cuts);
        const double cost = costOf(classes, volume, radii.listing * typicalMarginInRadii);
        if (cost < least) {
            least = cost;
            best = std::move(classes);
        }
    }
    return best;
}

}  // namespace

RadiusStats radiusStatsOf(const scene::Scene& scene) {
    constexpr double packing = 0.6;
    if (!scene::mayHaveAny(scene)) return {0.05, 0.05, 0.05, 0.05, {{0.05, 0.05, 0}}};
    RadiusStats radii{1e30, 0, 0, 0, {}};
    double inverses = 0;
    double cubes = 0;
    auto count = static_cast<double>(scene.spheres.size());
    for (const scene::Emitter& emitter : scene.emitters) count += emitter.expected;
    scene::forEachSphere(scene, [&](const scene::Sphere& sphere, double weight) {
        const auto r = static_cast<double>(sphere.radius);
        radii.smallest = std::min(radii.smallest, r);
        radii.largest = std::max(radii.largest, r);
        radii.mean += weight * r / count;
        inverses += weight / (r * r * r * count);
        cubes += weight * r * r * r;
    });
    radii.listing = 1 / std::cbrt(inverses);
    radii.classes = classesOf(scene, radii, ball * cubes / packing);
    return radii;
}

}  // namespace spherule::sim
