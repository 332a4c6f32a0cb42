// The part of Pipeline that goes on with other obstacles.
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

void Pipeline::takeFrom(Pipeline& before, const NewKey& newKey) {
    for (const ArraySpec& spec : plan_.arrays) {
        if (dependsOnObstacles(spec.array) || !before.plan_.has(spec.array)) continue;
        const std::size_t bytes = std::min(spec.bytes, before.plan_.bytesOf(spec.array));
        copy(before.buffer(spec.array), 0, bytes, buffer(spec.array), 0);
    }
    takeWallMemory(before, newKey);
    substepLength_ = before.substepLength_;
    impactsPending_ = before.impactsPending_;
    requestRebuild();
}

void Pipeline::takeWallMemory(Pipeline& before, const NewKey& newKey) {
    const std::uint32_t least = std::min(plan_.maxWallHistory, before.plan_.maxWallHistory);
    for (const Array array : {Array::WallImpulse, Array::WallTorque, Array::WallSlip}) {
        if (!plan_.has(array) || !before.plan_.has(array)) continue;
        // The rows of torques have no surface: they belong to the rows of impulses.
        const auto old = before.read<glm::vec4>(array);
        const auto keys = before.read<glm::vec4>(array == Array::WallTorque ? Array::WallImpulse : array);
        std::vector<glm::vec4> rows(std::size_t{plan_.room} * plan_.maxWallHistory);
        for (std::size_t handle = 0; handle < plan_.room; ++handle)
            for (std::uint32_t k = 0; k < least; ++k) {
                const std::size_t from = handle * before.plan_.maxWallHistory + k;
                if (keys[from].w == 0) continue;
                const auto key = newKey(static_cast<std::uint32_t>(keys[from].w) - 1);
                if (!key) continue;
                glm::vec4& row = rows[handle * plan_.maxWallHistory + k];
                row = old[from];
                if (array != Array::WallTorque) row.w = static_cast<float>(*key + 1);
            }
        write<glm::vec4>(array, rows);
    }
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
