#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

namespace spherule::scene {

struct Sphere {
    glm::dvec3 position{};      // m
    glm::vec3 velocity{};       // m/s
    float radius = 0;           // m
    std::uint8_t material = 0;  // index into Scene::materials
    bool fixed = false;         // infinite mass: nothing moves it
    std::uint16_t group = 0;    // index into Scene::groups, if there are any
    glm::vec3 spin{};           // angular velocity, rad/s
};

}  // namespace spherule::scene
