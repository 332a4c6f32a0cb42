#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.h"
#include "sim/contact_sums.h"
#include "sim/pipeline.h"

namespace spherule::sim {

// Sums over the impacts between spheres in the observed steps. Only in the models `fast` and `balanced`: in `accurate`
// an impact takes many substeps, and is not measured.
struct Impacts {
    double count = 0;
    double approach = 0;  // sum of the speeds of approach along the normal (m/s)
    double parting = 0;   // sum of the speeds of parting (m/s)
    double asked = 0;     // sum of the speeds of parting that the scene's restitution requires (m/s)

    // Restitution weighted by the speed of approach. Call only if `count` is not 0.
    [[nodiscard]] double restitution() const { return parting / approach; }
    [[nodiscard]] double restitutionAsked() const { return asked / approach; }
    // Returns these impacts without the impacts in `before`.
    [[nodiscard]] Impacts since(const Impacts& before) const;
};

// The force that spheres exert on a wall or an obstacle (N), and its torque about the centre of the bounds (N m).
struct SurfaceForce {
    std::string surface;  // a face as scenes name it, such as Z_MIN, or an obstacle, such as obstacles[0]
    glm::dvec3 force{};
    glm::dvec3 torque{};
};

// The spheres that have passed an emitter or a sink.
struct FlowCounts {
    std::uint64_t spheres = 0;
    double mass = 0;              // kg
    double spheresPerSecond = 0;  // in the last full second (simulated)
    double massPerSecond = 0;     // kg/s, likewise
};

struct EmitterCounts {
    std::string name;  // as in the scene
    FlowCounts born;
    std::uint64_t blocked = 0;  // spheres that found no free place
    std::uint64_t waiting = 0;  // spheres that are due, and will be tried again
    bool ended = false;         // it has made its total, or has been choked, and makes no more
};

struct SinkCounts {
    FlowCounts taken;
    std::vector<std::uint64_t> byMaterial;  // spheres, in the order of the scene's materials
};

// Statistics in SI units. Overlaps are fractions of the (smaller) radius.
struct Statistics {
    std::uint64_t step = 0;
    double time = 0;  // s simulated
    std::uint32_t spheres = 0;
    std::uint64_t born = 0;                 // since the world began, the scene's spheres included
    std::uint64_t removed = 0;              // by commands and sinks
    std::vector<EmitterCounts> emitters{};  // since the world began, in the order of the scene
    std::vector<SinkCounts> sinks{};
    double kineticEnergy = 0;
    double rotationalEnergy = 0;
    double elasticEnergy = 0;    // of the springs of `accurate`; 0 in the other models
    double potentialEnergy = 0;  // of gravity, zero at the lowest corner of the bounds, and of fields
    // Potential energy of gravity along periodic axes, at unwrapped positions (J). It is no part of potentialEnergy,
    // because it has no lowest value. Its fall is the work of this gravity.
    double unboundedEnergy = 0;
    double fieldEnergy = 0;  // the part of the potential energy in fields
    double pushWork = 0;  // work of the pushes of `fast` out of walls against gravity and fields, since the last upload
    glm::dvec3 momentum{};
    glm::dvec3 angularMomentum{};  // N m s, about the bounds' centre; not conserved with periodic axes
    std::uint64_t contacts = 0;
    double overlapMean = 0;  // over overlapping pairs
    double overlapMax = 0;
    double wallOverlapMax = 0;
    double speedMax = 0;
    double speedRms = 0;    // over the spheres that are not fixed, as all sums
    double meanHeight = 0;  // z above the bounds' floor
    std::uint32_t sleeping = 0;
    std::uint32_t outside = 0;
    std::uint32_t nonFinite = 0;
    Impacts impacts;  // since the spheres were last placed or added to
    // In scenes with contact sums:
    std::optional<ContactSums> contactSums{};   // since then
    std::optional<Tensor> contactStress{};      // Pa: mean since then; absent at the beginning
    std::vector<SurfaceForce> surfaceForces{};  // means since then; empty at the beginning
    Tensor kineticStress{};                     // Pa: sum of m v v over the volume of the bounds
    std::optional<std::uint64_t> stateHash{};   // of a query that asked for it: hashOf() of the same state

    // Returns the largest overlap with a sphere or a wall.
    [[nodiscard]] double deepest() const { return std::max(overlapMax, wallOverlapMax); }
};

// Returns the name of a surface as in SurfaceForce. `surface`: its number through faces and parts of obstacles.
std::string surfaceName(const scene::Scene& scene, std::uint32_t surface);

// Returns the mean forces on the closed faces and on the obstacles over the time of `sums`, in the order of the scene.
// An obstacle bears the loads of all its surfaces. Without any time, or without surfaces, there are none.
std::vector<SurfaceForce> meanForces(const ContactSums& sums, const scene::Scene& scene);

// Sets the means over the time of `sums`: the stress by contacts, which is the virial over the time and over the volume
// of the bounds, and the forces. Without any time there are none of them.
void setMeans(Statistics& statistics, const ContactSums& sums, const scene::Scene& scene);

// Computes statistics. The device sums in blocks, the host adds the blocks in double. Waits for the device.
Statistics measure(Pipeline& pipeline, const scene::Scene& scene);

// Adds the impacts observed since the last call. Waits for the device.
void addImpacts(Impacts& sum, Pipeline& pipeline);

}  // namespace spherule::sim
