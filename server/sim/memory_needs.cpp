#include "sim/memory_needs.h"

#include <numeric>

#include <fmt/format.h>
#include <glm/vec4.hpp>

#include "scene/occupancy.h"
#include "scene/scene.h"
#include "sim/layout.h"
#include "sim/mesh_tables.h"
#include "sim/sphere_columns.h"

namespace spherule::sim {

namespace {

// Per sphere: the columns of a State.
constexpr std::uint64_t stateBytes = [] {
    std::uint64_t bytes = 0;
    forEachColumn([&]<class T>(std::vector<T> SphereColumns::*, Array) { bytes += sizeof(T); });
    return bytes;
}();
// Ids and materials during an upload.
constexpr std::uint64_t uploadBytes = sizeof(std::uint32_t) + sizeof(std::uint8_t);
// The radii that are sent to viewers: in a message, and in its encoded copy.
constexpr std::uint64_t radiiBytes = 2 * sizeof(float);

// With periodic axes, of a State and of a SlotState.
constexpr std::uint64_t imageBytes = sizeof(glm::ivec3);
constexpr std::uint64_t slotImageBytes = sizeof(glm::uvec4);

// Returns the bytes of a SlotState per sphere. It has the columns that the plan has, and the ids with the materials.
std::uint64_t slotBytes(const Plan& plan) {
    std::uint64_t bytes = sizeof(std::uint32_t);
    forEachColumn([&]<class T>(std::vector<T> SphereColumns::*, Array array) {
        if (plan.has(array)) bytes += sizeof(T);
    });
    return bytes + (plan.features.has(Feature::Periodic) ? slotImageBytes : 0);
}

std::uint64_t snapshotBytes(const Plan& plan) {
    return stateBytes + slotBytes(plan) + (plan.features.has(Feature::Periodic) ? imageBytes : 0);
}

}  // namespace

std::uint64_t MemoryNeeds::onHost() const {
    return std::accumulate(host.begin(), host.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const MemoryPart& part) { return sum + part.bytes; });
}

std::vector<MemoryPart> MemoryNeeds::parts() const {
    std::vector<MemoryPart> all{{"device: arrays", arrays}};
    for (const MemoryPart& part : host) all.push_back(part);
    all.insert(all.end(), {{"host: for a time", temporary},
                           {"all, where device and host are one", arrays + onHost() + temporary}});
    return all;
}

MemoryNeeds memoryNeedsOf(const Plan& plan) {
    const std::uint64_t n = plan.spheres;
    MemoryNeeds need{
        .arrays = plan.bytes(),
        .host = {{"host: scene", n * sizeof(scene::Sphere)}, {"host: scene at the start", n * sizeof(scene::Sphere)}},
        .temporary = n * snapshotBytes(plan)};
    if (plan.meshes) need.host.push_back({"host: meshes", plan.meshes->bytes()});
    if (plan.features.has(Feature::Radii)) need.host.push_back({"host: radii for viewers", n * radiiBytes});
    return need;
}

std::uint64_t arraysOnHost(const compute::Device& device, const Plan& plan) {
    std::uint64_t bytes = 0;
    for (const ArraySpec& spec : plan.arrays) bytes += device.hostBytes(spec.bytes, typeOf(spec.array).words);
    return bytes;
}

Result<memory::Claim> claimForState(const scene::Scene& scene) {
    const std::size_t spheres = scene.spheres.size();
    return memory::Claim::make("", fmt::format("the states of {} spheres", spheres),
                               spheres * (stateBytes + (scene.bounds.anyPeriodic() ? imageBytes : 0)));
}

Result<memory::Claim> claimFor(const compute::Device& device, const Plan& plan) {
    const MemoryNeeds need = memoryNeedsOf(plan);
    const std::uint64_t alreadyHeld = std::uint64_t{plan.spheres} * sizeof(scene::Sphere);
    return memory::Claim::make("", fmt::format("a scene of {} spheres", plan.spheres),
                               arraysOnHost(device, plan) + need.onHost() - alreadyHeld + need.temporary);
}

void settleClaim(memory::Claim& claim, const compute::Device& device, const Plan& plan) {
    const MemoryNeeds need = memoryNeedsOf(plan);
    claim.settle(arraysOnHost(device, plan) + need.onHost(), need.temporary);
}

std::uint64_t copiesToChange(const Plan& plan) {
    return plan.spheres * (sizeof(scene::Sphere) + snapshotBytes(plan) + uploadBytes);
}

std::uint64_t copiesToSpawn(const Plan& plan) {
    // The scene as it is now, and as it grows.
    return copiesToChange(plan) + plan.spheres * (2 * sizeof(scene::Sphere) + scene::Occupancy::mostBytesPerSphere());
}

std::uint64_t copiesToHash(const Plan& plan) {
    return plan.spheres * snapshotBytes(plan);
}

}  // namespace spherule::sim
