#include "recording/unwrap.h"

#include "scene/scene.h"

namespace spherule::recording {

std::span<const glm::dvec3> Unwrapper::follow(const Snapshot& snapshot) {
    if (scene_ != snapshot.scene || positions_.size() != snapshot.positions.size()) {
        positions_.assign(snapshot.positions.begin(), snapshot.positions.end());
        scene_ = snapshot.scene;
        return positions_;
    }
    for (std::size_t id = 0; id < positions_.size(); ++id)
        positions_[id] += scene::separation(snapshot.positions[id], positions_[id], snapshot.spheres->periods);
    return positions_;
}

}  // namespace spherule::recording
