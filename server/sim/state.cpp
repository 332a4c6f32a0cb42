#include "sim/state.h"

#include <cmath>
#include <numbers>

#include <xxhash.h>
#include <glm/geometric.hpp>

namespace spherule::sim {

namespace {

glm::vec4 positionIn(const scene::Scene& scene, const scene::Sphere& sphere) {
    return {glm::vec3(sphere.position - scene.bounds.centre()), sphere.radius};
}

}  // namespace

void State::append(const State& more) {
    const auto join = [](auto& values, const auto& others) {
        values.insert(values.end(), others.begin(), others.end());
    };
    forEachColumn([&](auto column, Array /*array*/) { join(this->*column, more.*column); });
    join(images, more.images);
}

State stateOf(const scene::Scene& scene) {
    return stateOf(scene, scene.spheres);
}

double massOf(const scene::Scene& scene, const scene::Sphere& sphere) {
    const auto r = static_cast<double>(sphere.radius);
    return 4.0 / 3 * std::numbers::pi * r * r * r * scene.materials[sphere.material].density;
}

float inverseMassOf(const scene::Scene& scene, const scene::Sphere& sphere) {
    return sphere.fixed ? 0.0F : static_cast<float>(1 / massOf(scene, sphere));
}

State stateOf(const scene::Scene& scene, std::span<const scene::Sphere> spheres) {
    State state;
    forEachColumn([&](auto column, Array /*array*/) { (state.*column).reserve(spheres.size()); });
    for (const scene::Sphere& sphere : spheres) {
#define SPHERE_COLUMN(member, Type, ArrayName, value) state.member.emplace_back(value);
#include "sim/sphere_columns.def"
#undef SPHERE_COLUMN
    }
    if (scene.bounds.anyPeriodic()) state.images.resize(spheres.size());
    return state;
}

std::vector<std::uint8_t> materialsOf(const scene::Scene& scene) {
    std::vector<std::uint8_t> materials;
    materials.reserve(scene.spheres.size());
    for (const scene::Sphere& sphere : scene.spheres) materials.push_back(sphere.material);
    return materials;
}

glm::dvec3 positionOf(const State& state, std::uint32_t id) {
    return glm::dvec3(state.position[id]);
}

glm::dvec3 unwrappedOf(const State& state, std::uint32_t id, const glm::dvec3& periods) {
    return positionOf(state, id) + (state.images.empty() ? glm::dvec3(0) : glm::dvec3(state.images[id]) * periods);
}

glm::dvec3 velocityOf(const State& state, std::uint32_t id) {
    return glm::dvec3(state.velocity[id]);
}

glm::dvec3 spinOf(const State& state, std::uint32_t id) {
    return glm::dvec3(state.spin[id]);
}

bool isFixed(const State& state, std::uint32_t id) {
    return state.velocity[id].w == 0;
}

double massOf(const State& state, std::uint32_t id) {
    return 1 / std::abs(static_cast<double>(state.velocity[id].w));
}

double radiusOf(const State& state, std::uint32_t id) {
    return static_cast<double>(state.position[id].w);
}

double kineticEnergyOf(const State& state) {
    double sum = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        if (isFixed(state, id)) continue;
        const glm::dvec3 v = velocityOf(state, id);
        const glm::dvec3 rim = radiusOf(state, id) * spinOf(state, id);
        sum += massOf(state, id) * (glm::dot(v, v) / 2 + glm::dot(rim, rim) / 5);
    }
    return sum;
}

glm::dvec3 momentumOf(const State& state) {
    glm::dvec3 sum{};
    for (std::uint32_t id = 0; id < state.count(); ++id)
        if (!isFixed(state, id)) sum += massOf(state, id) * velocityOf(state, id);
    return sum;
}

double momentumScale(const State& state) {
    double sum = 0;
    for (std::uint32_t id = 0; id < state.count(); ++id)
        if (!isFixed(state, id)) sum += massOf(state, id) * glm::length(velocityOf(state, id));
    return sum;
}

std::uint64_t hashOf(const State& state) {
    XXH3_state_t* hash = XXH3_createState();
    XXH3_64bits_reset(hash);
    for (std::uint32_t rank = 0; rank < state.count(); ++rank) {
        const std::uint64_t id = state.idAt(rank);
        const bool isShort = id <= 0xffffffff;
        XXH3_64bits_update(hash, &id, isShort ? sizeof(std::uint32_t) : sizeof id);
        XXH3_64bits_update(hash, &state.position[rank], 3 * sizeof(float));
        XXH3_64bits_update(hash, &state.velocity[rank], 3 * sizeof(float));
        XXH3_64bits_update(hash, &state.spin[rank], 3 * sizeof(float));
    }
    const std::uint64_t digest = XXH3_64bits_digest(hash);
    XXH3_freeState(hash);
    return digest;
}

}  // namespace spherule::sim
