#include "sim/contact_sums.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "sim/state.h"

namespace spherule::sim {

ContactSums ContactSums::since(const ContactSums& before) const {
    if (seconds < before.seconds) return *this;  // `before` is of another world
    ContactSums difference{.seconds = seconds - before.seconds,
                           .collisions = collisions - before.collisions,
                           .dissipated = dissipated - before.dissipated};
    for (std::size_t k = 0; k < virial.size(); ++k) difference.virial[k] = virial[k] - before.virial[k];
    difference.loads = loads;
    for (std::size_t k = 0; k < std::min(loads.size(), before.loads.size()); ++k) {
        difference.loads[k].impulse -= before.loads[k].impulse;
        difference.loads[k].moment -= before.loads[k].moment;
    }
    return difference;
}

LoadUnits LoadUnits::of(const scene::Scene& scene) {
    // Per unit of impulse, all spheres together change their velocity by this much (m/s).
    constexpr int velocityExponent = -44;
    constexpr int mostExponent = 100;  // the reciprocals must be floats
    double mass = 0;
    for (const scene::Sphere& sphere : scene.spheres)
        if (!sphere.fixed) mass += massOf(scene, sphere);
    const glm::dvec3 half = 0.5 * (scene.bounds.max - scene.bounds.min);
    const int massExponent = mass > 0 ? std::ilogb(mass) + 1 : 0;
    const int lengthExponent = std::ilogb(glm::length(half)) + 1;
    const int impulse = std::clamp(massExponent + velocityExponent, -mostExponent, mostExponent);
    const int moment = std::clamp(impulse + lengthExponent, -mostExponent, mostExponent);
    return {.impulse = std::ldexp(1, impulse), .moment = std::ldexp(1, moment)};
}

SurfaceLoad surfaceLoadIn(std::span<const std::uint32_t> words, const LoadUnits& units) {
    std::array<std::uint64_t, SURFACE_SUM_WORDS / 2> components{};
    for (std::size_t copy = 0; copy < SURFACE_SUM_COPIES; ++copy)
        for (std::size_t k = 0; k < components.size(); ++k) {
            const std::size_t word = copy * SURFACE_SUM_WORDS + 2 * k;
            components[k] += words[word] | std::uint64_t{words[word + 1]} << 32U;
        }
    // The device counts what the spheres get.
    const auto value = [&](std::size_t k) { return -static_cast<double>(static_cast<std::int64_t>(components[k])); };
    return {glm::dvec3(value(0), value(1), value(2)) * units.impulse,
            glm::dvec3(value(3), value(4), value(5)) * units.moment};
}

void addSurfaceLoads(ContactSums& sum, std::size_t surfaces, Pipeline& pipeline, const LoadUnits& units) {
    if (!pipeline.plan().has(Array::SurfaceSums)) return;
    std::vector<std::uint32_t> words;
    pipeline.readInto(words, Array::SurfaceSums, surfaces * surfaceSumWords);
    sum.loads.resize(surfaces);
    for (std::size_t surface = 0; surface < surfaces; ++surface) {
        const SurfaceLoad load =
            surfaceLoadIn(std::span(words).subspan(surface * surfaceSumWords, surfaceSumWords), units);
        sum.loads[surface].impulse += load.impulse;
        sum.loads[surface].moment += load.moment;
    }
    std::ranges::fill(words, 0U);
    pipeline.write<std::uint32_t>(Array::SurfaceSums, words);
}

void addContactSums(ContactSums& sum, Pipeline& pipeline) {
    std::vector<float> work = pipeline.read<float>(Array::WorkOfContacts);
    for (float& part : work) sum.dissipated -= static_cast<double>(std::exchange(part, 0.0F));
    pipeline.write<float>(Array::WorkOfContacts, work);
    if (!pipeline.plan().has(Array::Bundles)) return;
    const std::size_t first = (std::size_t{pipeline.plan().grid.bundles()} + 1) * BUNDLE_WORDS;
    std::vector<std::uint32_t> words = pipeline.read<std::uint32_t>(Array::Bundles);
    const std::span<std::uint32_t> rows = std::span(words).subspan(first);
    for (std::size_t row = 0; row < rows.size(); row += SUM_WORDS) {
        const auto value = [&](std::size_t k) { return static_cast<double>(std::bit_cast<float>(rows[row + k])); };
        for (std::size_t k = 0; k < sum.virial.size(); ++k)
            if (std::isfinite(value(k))) sum.virial[k] += value(k);
        sum.collisions += value(sum.virial.size());
    }
    std::ranges::fill(rows, 0U);
    pipeline.write<std::uint32_t>(Array::Bundles, rows, first);
}

}  // namespace spherule::sim
