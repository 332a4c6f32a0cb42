#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/box.h"
#include "scene/emitter.h"
#include "scene/forces.h"
#include "scene/motion.h"
#include "scene/sphere.h"

namespace spherule::scene {

// A validated scene, in SI units and world coordinates.

struct Material {
    std::string name{};
    double density = 1000;     // kg/m^3
    double restitution = 0.5;  // 0..1
    double friction = 0;
    double rollingResistance = 0;
    double spinningResistance = 0;
    double young = 0;  // Pa; 0: chosen by the model
    double poisson = 0.25;

    bool operator==(const Material&) const = default;
};

// Values between materials `a` and `b`. They replace the values computed from each material.
struct MaterialPair {
    std::uint8_t a = 0;
    std::uint8_t b = 0;
    std::optional<double> restitution;
    std::optional<double> friction;
    std::optional<double> rollingResistance;
    std::optional<double> spinningResistance;
};

enum class Model : std::uint8_t { Fast, Balanced, Accurate };

// The goal for moving substeps while a scene runs: the longest time of a step, or the largest overlap of spheres.
struct QualityGoal {
    enum class Kind : std::uint8_t { StepTime, Overlap } kind = Kind::StepTime;
    double max = 0;  // wall ms per step; mean overlap over the radius

    bool operator==(const QualityGoal&) const = default;
};

struct Quality {
    Model model = Model::Balanced;
    std::uint32_t substeps = 1;         // per step
    bool substepsFixed = true;          // substeps are requested, not chosen by the model
    double overlap = 0.1;               // of the radius: target of `accurate` when it chooses stiffness and substeps
    std::optional<QualityGoal> goal{};  // nullopt: substeps stay the same
};

// How the spheres of a group look in pictures.
struct Look {
    std::string colour;       // "#rrggbb"; empty: the viewer chooses
    double roughness = 0.45;  // of the surface, 0 to 1
    double metal = 0;         // 0 to 1
};

struct Group {
    std::string name;
    std::uint32_t count = 0;  // of its spheres
    Look look;
    std::uint8_t material = 0;  // of its spheres: index into Scene::materials
    bool fixed = false;         // as of its spheres
};

enum Face : std::uint8_t { XMin, XMax, YMin, YMax, ZMin, ZMax };

// Each axis is periodic, or each of its faces is a wall or open. A sphere that leaves through one face of a periodic
// axis comes back through the other.
struct Bounds {
    glm::dvec3 min{};
    glm::dvec3 max{};
    std::array<bool, 6> open{};      // by Face
    std::array<bool, 3> periodic{};  // by axis; its faces are not open
    std::uint8_t material = 0;

    [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (min + max); }
    [[nodiscard]] bool walled(std::size_t face) const { return !open[face] && !periodic[face / 2]; }
    [[nodiscard]] bool anyPeriodic() const { return periodic[0] || periodic[1] || periodic[2]; }
    // Returns the length of each periodic axis (m); 0 for the others.
    [[nodiscard]] glm::dvec3 periods() const;
};

inline glm::dvec3 Bounds::periods() const {
    glm::dvec3 lengths(0);
    for (int axis = 0; axis < 3; ++axis)
        if (periodic[static_cast<std::size_t>(axis)]) lengths[axis] = max[axis] - min[axis];
    return lengths;
}

// The counterparts of shaders/shared/separation.h. `periods`: as Bounds::periods() returns them.

// Returns the vector from b to the nearest image of a.
inline glm::dvec3 separation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& periods) {
    glm::dvec3 d = a - b;
    for (int axis = 0; axis < 3; ++axis)
        if (periods[axis] > 0) d[axis] -= periods[axis] * std::floor(d[axis] / periods[axis] + 0.5);
    return d;
}

class Shape;

struct Obstacle {
    std::shared_ptr<const Shape> shape;  // see scene/shapes.h; null: it was refused, and is nowhere
    std::uint8_t material = 0;
    std::string colour;
    std::optional<Motion> motion{};  // nullopt: at rest

    // Returns how far it has moved from its place in the scene at this time.
    [[nodiscard]] Frame movedBy(double time) const { return motion ? motion->poseAt(time).frame() : Frame(); }
    // Returns the distance of a point from the solid at this time (m), negative inside it.
    [[nodiscard]] double distance(const glm::dvec3& point, double time) const;
    // Returns the largest speed of a point of its surface at any time (m/s), without the belt's. A half-space counts
    // within the bounds.
    [[nodiscard]] double largestSpeed(const Bounds& bounds) const;
};

// Returns true if an obstacle moves.
bool anyMoves(const std::vector<Obstacle>& obstacles);

struct Camera {
    glm::dvec3 eye{};
    glm::dvec3 target{};
    double fieldOfView = 30;  // degrees, vertical
};

// The light in pictures.
struct Light {
    std::optional<glm::dvec3> direction{};  // to the light, of unit length; nullopt: the viewer chooses
    double strength = 1;                    // 0 to 10
    std::string colour{};                   // "#rrggbb"; empty: the viewer chooses
    double sky = 1;                         // strength of the light from all sides, 0 to 10
};

struct Sleep {
    bool enabled = true;
    double speed = 0.02;  // m/s
    double time = 0.5;    // s
};

struct Scene {
    std::string name;
    std::string description;
    std::string whatToTry;  // by a viewer
    Forces forces;
    Bounds bounds;
    std::vector<Obstacle> obstacles;
    std::vector<Group> groups;
    std::vector<Sphere> spheres;  // in the order of their ids
    std::vector<Emitter> emitters;
    std::vector<Material> materials{Material{}};  // at least one
    std::vector<MaterialPair> pairs;
    double step = 1.0 / 60;  // s
    Quality quality;
    Camera camera;
    std::optional<Light> light;  // nullopt: the viewer chooses
    Sleep sleep;
    std::vector<Box> sinks;  // spheres whose centre is inside at the end of a step are removed
    bool sphereContacts = true;
    bool contactSums = false;  // statistics have sums over the contacts of all substeps
    double time = 0;           // s simulated: new spheres are placed beside obstacles as they are then
};

// Calls visit(sphere, weight) for each sphere of the scene, and for samples of those that emitters make. `weight`: how
// many spheres it stands for.
template <class Visit>
void forEachSphere(const Scene& scene, Visit visit) {
    for (const Sphere& sphere : scene.spheres) visit(sphere, 1.0);
    for (const Emitter& emitter : scene.emitters)
        for (const Sphere& sphere : emitter.samples)
            visit(sphere, emitter.expected / static_cast<double>(emitter.samples.size()));
}

// Returns true if the scene has spheres, or may get some from emitters.
inline bool mayHaveAny(const Scene& scene) {
    return !scene.spheres.empty() || !scene.emitters.empty();
}

// Returns true if two spheres may be in the scene at the same time.
inline bool mayHaveTwo(const Scene& scene) {
    return scene.spheres.size() > 1 || !scene.emitters.empty();
}

// Removes the spheres with these numbers, in ascending order, from the scene and its groups.
void removeSpheres(Scene& scene, const std::vector<std::uint32_t>& numbers);

// Removes the groups without spheres, but not the groups of emitters. The other groups get new numbers.
void removeEmptyGroups(Scene& scene);

}  // namespace spherule::scene
