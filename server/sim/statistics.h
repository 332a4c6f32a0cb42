#pragma once

#include <algorithm>
#include <cstdint>

#include <glm/vec3.hpp>

#include "scene/scene.h"
#include "sim/pipeline.h"

namespace spherule::sim {

// What was observed, in some of the steps, of spheres that met spheres. In the models `fast` and `balanced`: in
// `accurate` an impact takes many substeps, which nobody adds up.
struct Impacts {
    double count = 0;
    double approach = 0;  // sum of their speeds along the normal, m/s
    double parting = 0;
    double asked = 0;  // sum of the partings that the scene's restitution asks for

    // Weighted by the speed of approach. Only where there are impacts.
    [[nodiscard]] double restitution() const { return parting / approach; }
    [[nodiscard]] double restitutionAsked() const { return asked / approach; }
    // Without those of before.
    [[nodiscard]] Impacts since(const Impacts& before) const;
};

// SI units; overlaps as fractions of the (smaller) radius.
struct Statistics {
    std::uint64_t step = 0;
    double time = 0;  // s simulated
    std::uint32_t spheres = 0;
    double kineticEnergy = 0;
    double rotationalEnergy = 0;
    double elasticEnergy = 0;    // of the springs of `accurate`; 0 in the other models, whose spheres are hard
    double potentialEnergy = 0;  // zero at the lowest corner of the bounds
    double pushWork = 0;  // of `fast`'s pushes out of walls against gravity, since the spheres were last put there
    glm::dvec3 momentum{};
    glm::dvec3 angularMomentum{};  // N m s, about the bounds' centre
    std::uint64_t contacts = 0;
    double overlapMean = 0;  // over overlapping pairs
    double overlapMax = 0;
    double wallOverlapMax = 0;
    double speedMax = 0;
    double speedRms = 0;
    double meanHeight = 0;  // z above the bounds' floor
    std::uint32_t sleeping = 0;
    std::uint32_t outside = 0;
    std::uint32_t nonFinite = 0;
    Impacts impacts;  // since the spheres were last placed or added to

    // The largest overlap with anything.
    [[nodiscard]] double deepest() const { return std::max(overlapMax, wallOverlapMax); }
};

// Summed on the device in blocks, the blocks in double here. Waits for the device.
Statistics measure(Pipeline& pipeline, const scene::Scene& scene);

// Adds what has been observed since the last time. Waits for the device.
void addImpacts(Impacts& sum, Pipeline& pipeline);

}  // namespace spherule::sim
