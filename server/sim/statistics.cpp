#include "sim/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scene/shapes.h"

namespace spherule::sim {

namespace {

// Returns the components of gravity along the periodic axes (m/s^2), 0 along the others.
glm::dvec3 periodicGravity(const scene::Scene& scene) {
    glm::dvec3 g(0);
    for (int axis = 0; axis < 3; ++axis)
        if (scene.bounds.periodic[static_cast<std::size_t>(axis)]) g[axis] = scene.forces.gravity[axis];
    return g;
}

// Returns the potential energy under gravity (J), without the components along periodic axes. `weighted`: sum of mass
// times position (kg m, relative to the bounds' centre); w: total mass (kg).
double potentialEnergy(const scene::Scene& scene, const glm::dvec4& weighted) {
    const glm::dvec3 half = 0.5 * (scene.bounds.max - scene.bounds.min);
    const glm::dvec3 g = scene.forces.gravity - periodicGravity(scene);
    const glm::dvec3 lowest(std::copysign(half.x, g.x), std::copysign(half.y, g.y), std::copysign(half.z, g.z));
    return weighted.w * glm::dot(g, lowest) - glm::dot(g, glm::dvec3(weighted));
}

void addOverlaps(Statistics& sum, const std::vector<glm::vec4>& groups) {
    double overlaps = 0;
    for (const glm::vec4& group : groups) {
        sum.contacts += static_cast<std::uint64_t>(group.x);
        overlaps += static_cast<double>(group.y);
        sum.elasticEnergy += static_cast<double>(group.w);
        sum.overlapMax = std::max(sum.overlapMax, static_cast<double>(group.z));
    }
    if (sum.contacts > 0) sum.overlapMean = overlaps / static_cast<double>(sum.contacts);
}

double volumeOf(const scene::Bounds& bounds) {
    const glm::dvec3 size = bounds.max - bounds.min;
    return size.x * size.y * size.z;
}

}  // namespace

std::string surfaceName(const scene::Scene& scene, std::uint32_t surface) {
    constexpr std::array<const char*, scene::faceCount> faceNames = {"X_MIN", "X_MAX", "Y_MIN",
                                                                     "Y_MAX", "Z_MIN", "Z_MAX"};
    if (surface < faceNames.size()) return faceNames[surface];
    std::size_t obstacle = 0;
    for (std::size_t end = scene::faceCount; obstacle < scene.obstacles.size(); ++obstacle) {
        end += scene.obstacles[obstacle].shape->parts();
        if (surface < end) break;
    }
    return fmt::format("obstacles[{}]", obstacle);
}

std::vector<SurfaceForce> meanForces(const ContactSums& sums, const scene::Scene& scene) {
    std::vector<SurfaceForce> forces;
    if (sums.loads.empty() || !(sums.seconds > 0)) return forces;
    for (std::uint32_t face = 0; face < scene::faceCount; ++face)
        if (scene.bounds.walled(face))
            forces.push_back({surfaceName(scene, face), sums.loads[face].impulse / sums.seconds,
                              sums.loads[face].moment / sums.seconds});
    std::size_t surface = scene::faceCount;
    for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
        SurfaceForce sum{.surface = fmt::format("obstacles[{}]", k)};
        for (const std::size_t end = surface + scene.obstacles[k].shape->parts(); surface < end; ++surface) {
            sum.force += sums.loads[surface].impulse / sums.seconds;
            sum.torque += sums.loads[surface].moment / sums.seconds;
        }
        forces.push_back(std::move(sum));
    }
    return forces;
}

void setMeans(Statistics& statistics, const ContactSums& sums, const scene::Scene& scene) {
    statistics.surfaceForces = meanForces(sums, scene);
    statistics.contactStress.reset();
    if (!(sums.seconds > 0)) return;
    Tensor stress = sums.virial;
    for (double& component : stress) component /= sums.seconds * volumeOf(scene.bounds);
    statistics.contactStress = stress;
}

Impacts Impacts::since(const Impacts& before) const {
    if (count < before.count) return *this;  // `before` is of another world
    return {count - before.count, approach - before.approach, parting - before.parting, asked - before.asked};
}

void addImpacts(Impacts& sum, Pipeline& pipeline) {
    glm::dvec4 added{};
    for (const glm::vec4& group : pipeline.takeImpacts()) added += glm::dvec4(group);
    // Ignores the impacts of a state that is becoming non-finite.
    if (!std::isfinite(added.y + added.z + added.w)) return;
    sum.count += added.x;
    sum.approach += added.y;
    sum.parting += added.z;
    sum.asked += added.w;
}

Statistics measure(Pipeline& pipeline, const scene::Scene& scene) {
    Statistics sum;
    if (pipeline.plan().spheres == 0) return sum;
    pipeline.runStatistics();
    glm::dvec4 weighted{};
    double squares = 0;
    double heights = 0;
    double fastest = 0;
    std::uint32_t fixedSpheres = 0;
    Tensor flow{};
    for (const layout::SphereStatistics& part : pipeline.read<layout::SphereStatistics>(
             Array::SphereSums, blocksOf(pipeline.plan().spheres, STATISTIC_BLOCK))) {
        weighted += glm::dvec4(part.weighted);
        sum.momentum += glm::dvec3(part.momentum);
        sum.angularMomentum += glm::dvec3(part.angular);
        sum.rotationalEnergy += static_cast<double>(part.angular.w);
        sum.kineticEnergy += static_cast<double>(part.momentum.w);
        sum.elasticEnergy += static_cast<double>(part.wallSprings);
        sum.fieldEnergy += static_cast<double>(part.fieldEnergy);
        heights += static_cast<double>(part.heightSum);
        squares += static_cast<double>(part.speedSquares);
        fastest = std::max(fastest, static_cast<double>(part.speedSquaredMax));
        sum.wallOverlapMax = std::max(sum.wallOverlapMax, static_cast<double>(part.wallOverlapMax));
        sum.sleeping += part.sleeping;
        sum.outside += part.outside;
        sum.nonFinite += part.nonFinite;
        fixedSpheres += part.fixedSpheres;
        for (int axis = 0; axis < 3; ++axis) {
            flow[static_cast<std::size_t>(axis)] += static_cast<double>(part.flowDiagonal[axis]);
            flow[static_cast<std::size_t>(3 + axis)] += static_cast<double>(part.flowOther[axis]);
        }
    }
    for (std::size_t k = 0; k < flow.size(); ++k) sum.kineticStress[k] = flow[k] / volumeOf(scene.bounds);
    for (const float work : pipeline.read<float>(Array::WallWork)) sum.pushWork += static_cast<double>(work);
    addOverlaps(sum, pipeline.read<glm::vec4>(Array::Overlaps));
    sum.potentialEnergy = potentialEnergy(scene, weighted) + sum.fieldEnergy;
    sum.unboundedEnergy = -glm::dot(periodicGravity(scene), glm::dvec3(weighted));
    sum.speedMax = std::sqrt(fastest);
    const double finite = pipeline.plan().spheres - sum.nonFinite - fixedSpheres;
    if (finite > 0) {
        sum.speedRms = std::sqrt(squares / finite);
        sum.meanHeight = heights / finite + 0.5 * (scene.bounds.max.z - scene.bounds.min.z);
    }
    return sum;
}

}  // namespace spherule::sim
