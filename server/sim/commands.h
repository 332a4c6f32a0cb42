#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "core/result.h"
#include "scene/part_changes.h"
#include "scene/scene.h"
#include "sim/inspection.h"
#include "sim/statistics.h"

// The commands that a simulation carries out, as plain values.
namespace spherule::sim {

// Changes the settings that are present.
struct Set {
    std::optional<glm::dvec3> gravity{};                      // m/s^2
    std::optional<double> restitution{};                      // of all materials
    std::optional<double> friction{};                         // of all materials
    std::optional<scene::Model> model{};                      // also removes the goal
    std::optional<std::uint32_t> substeps{};                  // per step; also removes the goal
    std::optional<std::optional<scene::QualityGoal>> goal{};  // nullopt inside: removes the goal
};

// Returns to the beginning of the scene.
struct Reset {};

// Adds a group of spheres.
struct Spawn {
    std::string name{};
    scene::Look look{};
    // Finds a place for each sphere of the group in the scene. Called on a thread that does not own the device.
    std::function<Result<std::vector<scene::Sphere>>(const scene::Scene&, Progress&)> place{};
};

// Removes the spheres with these ids, and those whose centre is in the region.
struct Remove {
    std::vector<std::uint64_t> spheres{};
    std::optional<scene::Box> region{};  // m
};

struct Ray {
    glm::dvec3 origin{};     // m
    glm::dvec3 direction{};  // any length but zero
};

// Adds, moves or removes an obstacle.
struct ChangeObstacle {
    std::optional<std::uint32_t> obstacle{};  // its number; nullopt: a new one, behind the others
    // Returns the obstacle from now on; nullopt: it is removed. `scene`: the present scene, at its time.
    std::function<Result<std::optional<scene::Obstacle>>(const scene::Scene& scene)> make{};
};

// Changes a field, an emitter, a material or a group.
struct ChangePart {
    // Carries out the change on a scene at its time, and checks the scene. Called again when other kernels are ready,
    // with the scene as it is then.
    std::function<Result<scene::PartChange>(scene::Scene& scene)> make{};
};

// Removes a group with its spheres.
struct RemoveGroup {
    std::uint32_t number = 0;
};

// Gives an impulse to a sphere.
struct Push {
    std::variant<std::uint64_t, Ray> target{};  // the id of the sphere, or a ray: the first sphere that it meets
    glm::dvec3 impulse{};                       // N s
};

// Pulls a sphere to a point by a spring with critical damping, in every substep. Each session has one spring at most.
struct Pull {
    std::uint64_t session = 0;
    std::uint64_t sphere = 0;           // id
    glm::dvec3 point{};                 // m
    std::optional<double> stiffness{};  // N/m
};

// Ends the pull of the session.
struct Release {
    std::uint64_t session = 0;
};

using Command = std::variant<Set, Reset, Spawn, Remove, ChangeObstacle, ChangePart, RemoveGroup, Push, Pull, Release>;

// The result of a command.
struct Applied {
    std::uint64_t step = 0;                   // the command holds from this step on
    std::optional<std::uint64_t> sphere{};    // the sphere that a push hit
    std::optional<std::uint32_t> removed{};   // spheres that a Remove or RemoveGroup removed
    std::optional<std::uint32_t> obstacle{};  // number of the obstacle of a ChangeObstacle
    std::optional<std::uint32_t> number{};    // of the part of a ChangePart or RemoveGroup
    std::string file{};                       // name of the checkpoint that was written
    std::optional<Statistics> statistics{};   // of a query
    std::optional<Inspection> inspected{};    // of an inspection
    std::optional<glm::dvec3> force{};        // of the spring of a Pull (N)
};

// Returns the scene with the settings, and with the substeps that they require. Refused if a setting is out of range;
// the error's `where` is the name of the setting.
Result<scene::Scene> changedBy(const Set& set, scene::Scene scene);

}  // namespace spherule::sim
