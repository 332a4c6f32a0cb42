#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

namespace spherule::scene {

// A validated scene, in SI units and world coordinates. Ids are indices into `spheres`.

struct Sphere {
    glm::dvec3 position{};  // m
    glm::vec3 velocity{};   // m/s
    float radius = 0;       // m
    float density = 1000;   // kg/m^3
    float restitution = 0;  // 0..1
};

struct Group {
    std::string name;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::string colour;  // "#rrggbb" or empty
};

enum Face : std::uint8_t { XMin, XMax, YMin, YMax, ZMin, ZMax };

struct Bounds {
    glm::dvec3 min{};
    glm::dvec3 max{};
    std::array<bool, 6> open{};  // by Face
    double restitution = 0;

    [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (min + max); }
};

struct Plane {
    glm::dvec3 point{};
    glm::dvec3 normal{};  // unit length, to the free side
};

struct Box {
    glm::dvec3 min{};
    glm::dvec3 max{};
};

struct Obstacle {
    std::variant<Plane, Box> shape;
    double restitution = 0;
    std::string colour;
};

struct Camera {
    glm::dvec3 eye{};
    glm::dvec3 target{};
    double fieldOfView = 45;  // degrees, vertical
};

struct Sleep {
    bool enabled = true;
    double speed = 0.02;  // m/s
    double time = 0.5;    // s
};

struct Scene {
    std::string name;
    std::string description;
    glm::dvec3 gravity{};
    Bounds bounds;
    std::vector<Obstacle> obstacles;
    std::vector<Group> groups;
    std::vector<Sphere> spheres;
    double restitution = 0.5;
    double step = 1.0 / 60;      // s
    std::uint32_t substeps = 0;  // per step, at least 1
    Camera camera;
    Sleep sleep;
    bool sphereContacts = true;
};

}  // namespace spherule::scene
