#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "scene/scene.h"
#include "sim/pipeline.h"

namespace spherule::sim {

// SI units; overlaps as fractions of the (smaller) radius.
struct Statistics {
    double kineticEnergy = 0;
    double rotationalEnergy = 0;
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
};

// Summed on the device in blocks, the blocks in double here. Waits for the device.
Statistics measure(Pipeline& pipeline, const scene::Scene& scene);

}  // namespace spherule::sim
