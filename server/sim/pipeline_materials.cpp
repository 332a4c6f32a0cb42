// The part of Pipeline that changes the materials of spheres.
#include <cmath>

#include "sim/pipeline.h"

namespace spherule::sim {

void Pipeline::setMaterials(std::span<const std::uint8_t> materials, std::span<const float> inverseMasses) {
    auto words = read<std::uint32_t>(Array::IdAndMaterial, plan_.spheres);
    auto velocity = read<glm::vec4>(Array::Velocity, plan_.spheres);
    auto unheld = read<glm::vec4>(Array::UnheldVelocity, plan_.spheres);
    const auto spin = read<glm::vec4>(Array::AngularVelocity, plan_.spheres);
    auto unheldSpin = read<glm::vec4>(Array::UnheldSpin, plan_.spheres);
    for (std::size_t slot = 0; slot < words.size(); ++slot) {
        const std::uint32_t handle = words[slot] & idMask;
        words[slot] = handle | std::uint32_t{materials[handle]} << idBits;
        const float before = std::abs(velocity[slot].w);
        const float now = inverseMasses[handle];
        if (now == before) continue;
        velocity[slot].w = std::copysign(now, velocity[slot].w);
        // The impulses that contacts hold change the velocity of a lighter sphere by more.
        const float ratio = now / before;
        if (!unheld.empty()) {
            const glm::vec3 free(velocity[slot] - (velocity[slot] - unheld[slot]) * ratio);
            unheld[slot] = glm::vec4(free, unheld[slot].w);
        }
        if (!unheldSpin.empty()) unheldSpin[slot] = spin[slot] - (spin[slot] - unheldSpin[slot]) * ratio;
    }
    write<std::uint32_t>(Array::IdAndMaterial, words);
    write<glm::vec4>(Array::Velocity, velocity);
    if (!unheld.empty()) write<glm::vec4>(Array::UnheldVelocity, unheld);
    if (!unheldSpin.empty()) write<glm::vec4>(Array::UnheldSpin, unheldSpin);
    awaitSpeeds();
}

}  // namespace spherule::sim
