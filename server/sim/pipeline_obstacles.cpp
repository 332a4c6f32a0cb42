// The part of Pipeline that goes on with other obstacles or features.
#include <algorithm>
#include <cmath>

#include "sim/pipeline.h"

namespace spherule::sim {

namespace {

// Returns true if the elements of an array depend on the obstacles, or on the launches.
bool dependsOnObstacles(Array array) {
    switch (typeOf(array).extent) {
        case Extent::RememberedWall:
        case Extent::LaunchRow:
        case Extent::Obstacle:
        case Extent::ObstacleListWord:
        case Extent::MaterialPair:
        case Extent::SurfaceSumWord:
            return true;
        default:
            return false;
    }
}

}  // namespace

// Returns true if the lists and the memory of contacts have the same form in both.
bool Pipeline::hasListsAs(const Pipeline& before) const {
    for (std::size_t k = 0; k < arrayCount; ++k) {
        const auto array = static_cast<Array>(k);
        switch (typeOf(array).extent) {
            case Extent::Pair:
            case Extent::PairTwice:
            case Extent::BundleWord:
            case Extent::RememberedWall:
            case Extent::Obstacle:
            case Extent::ObstacleListWord:
                if (plan_.bytesOf(array) != before.plan_.bytesOf(array)) return false;
                break;
            default:
                break;
        }
    }
    return true;
}

void Pipeline::takeFrom(Pipeline& before) {
    if (!hasListsAs(before)) return takeFrom(before, [](std::uint32_t key) { return std::optional(key); });
    setSpheres(before.plan_.spheres);
    for (const ArraySpec& spec : plan_.arrays) {
        const Extent extent = typeOf(spec.array).extent;
        if (extent == Extent::MaterialPair || extent == Extent::SurfaceSumWord || !before.plan_.has(spec.array))
            continue;
        const std::size_t bytes = std::min(spec.bytes, before.plan_.bytesOf(spec.array));
        device_.copy(before.buffer(spec.array), 0, bytes, buffer(spec.array), 0);
    }
    substepLength_ = before.substepLength_;
    impactsPending_ = before.impactsPending_;
    listsPending_ = before.listsPending_;
    awaitSpeeds();
}

void Pipeline::takeFrom(Pipeline& before, const NewKey& newKey) {
    setSpheres(before.plan_.spheres);
    for (const ArraySpec& spec : plan_.arrays) {
        if (dependsOnObstacles(spec.array) || !before.plan_.has(spec.array)) continue;
        const std::size_t bytes = std::min(spec.bytes, before.plan_.bytesOf(spec.array));
        device_.copy(before.buffer(spec.array), 0, bytes, buffer(spec.array), 0);
    }
    takeWallMemory(before, newKey);
    substepLength_ = before.substepLength_;
    impactsPending_ = before.impactsPending_;
    requestRebuild();
}

// Gives remembered contacts their new keys. Spheres no longer hold the impulses of contacts that have ended.
void Pipeline::takeWallMemory(Pipeline& before, const NewKey& newKey) {
    const std::uint32_t oldMost = before.plan_.maxWallHistory;
    const std::uint32_t most = std::min(plan_.maxWallHistory, oldMost);
    const auto slots = read<std::uint32_t>(Array::SlotOf);
    const auto slotOfHandle = [&](std::size_t handle) { return slots.empty() ? handle : std::size_t{slots[handle]}; };
    const auto words = read<std::uint32_t>(Array::IdAndMaterial, plan_.spheres);
    const auto position = read<glm::vec4>(Array::Position);
    const auto velocity = read<glm::vec4>(Array::Velocity);
    auto unheld = read<glm::vec4>(Array::UnheldVelocity);
    auto unheldSpin = read<glm::vec4>(Array::UnheldSpin);
    for (const Array array : {Array::WallImpulse, Array::WallTorque, Array::WallSlip}) {
        if (!before.plan_.has(array)) continue;
        // The rows of torques have no surface: they belong to the rows of impulses.
        const auto old = before.read<glm::vec4>(array);
        const auto keys = before.read<glm::vec4>(array == Array::WallTorque ? Array::WallImpulse : array);
        std::vector<glm::vec4> rows(std::size_t{plan_.room} * plan_.maxWallHistory);
        for (std::size_t from = 0; from < old.size(); ++from) {
            if (keys[from].w == 0) continue;
            const std::size_t handle = from / oldMost;
            const std::size_t slot = slotOfHandle(handle);
            // The rows of a removed sphere stay. Its slot may be another sphere's by now.
            if (slot >= words.size() || (words[slot] & idMask) != handle) continue;
            const std::size_t k = from % oldMost;
            const auto key = newKey(static_cast<std::uint32_t>(keys[from].w) - 1);
            if (key && k < most) {
                glm::vec4& row = rows[handle * plan_.maxWallHistory + k];
                row = old[from];
                if (array != Array::WallTorque) row.w = static_cast<float>(*key + 1);
                continue;
            }
            const float inverseMass = std::abs(velocity[slot].w);
            const glm::vec4 part(glm::vec3(old[from]), 0);
            if (array == Array::WallImpulse && !unheld.empty()) unheld[slot] += part * inverseMass;
            if (array == Array::WallTorque && !unheldSpin.empty())
                unheldSpin[slot] -= part * (2.5F * inverseMass / position[slot].w);  // as in held_by_walls.comp
        }
        if (plan_.has(array)) write<glm::vec4>(array, rows);
    }
    if (!unheld.empty()) write<glm::vec4>(Array::UnheldVelocity, unheld);
    if (!unheldSpin.empty()) write<glm::vec4>(Array::UnheldSpin, unheldSpin);
}

void Pipeline::wake(std::span<const std::uint32_t> handles) {
    if (!plan_.features.has(Feature::Sleep) || handles.empty()) return;
    auto velocity = read<glm::vec4>(Array::Velocity);
    for (const std::uint32_t handle : handles) {
        glm::vec4& one = velocity[slotOf(handle)];
        one.w = std::abs(one.w);
    }
    write<glm::vec4>(Array::Velocity, velocity);
}

}  // namespace spherule::sim
