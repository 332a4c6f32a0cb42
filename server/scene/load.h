#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "scene/scene.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

constexpr std::uint32_t maxSpheres = 16'000'000;
constexpr std::uint32_t maxObstacles = 1000;
constexpr std::uint64_t maxObstaclePairs = 30'000'000;  // every sphere meets each obstacle, in each substep
constexpr std::uint32_t maxGroups = 10'000;             // all are sent to every viewer, again with each new group
constexpr std::size_t longestName = 200;                // bytes; of a scene and of a group
constexpr std::size_t longestAdvice = 500;              // bytes; of `whatToTry`
constexpr std::size_t maxSinks = 8;
constexpr std::uint32_t maxSubsteps = 1'000'000;

// Values of a scene that a caller may replace before it is built.
struct Overrides {
    std::optional<std::uint32_t> substeps{};
    std::optional<Model> model{};
    std::optional<QualityGoal> goal{};
    std::optional<std::uint64_t> seed{};  // replaces every seed of the scene
    bool noSleep = false;
    bool contactSums = false;
};

// `source` is a path to a JSON file, or the name of a scene that comes with the program. `deviceKind` ("gpu", "cpu",
// "software") decides how many spheres the scenes `rapids` and `box` have.
// `progress`, here and below, receives the progress and may cancel the work: Cancelled.
Result<Scene> load(const std::string& source, std::string_view deviceKind, const Overrides& overrides = {},
                   Progress* progress = nullptr);

// Returns the mistakes of the scene's file, of structure and of content; empty if load() accepts it. They are in the
// order of their places, "file:line:column: field.path". At most mostMistakes are returned. A file that is no JSON has
// structural mistakes alone. Errors of content that follow from a structural mistake are left out.
std::vector<Error> mistakesOf(const std::string& path);

// Returns the structural mistakes alone, without building the scene.
std::vector<Error> structuralMistakesOf(const std::string& path);

// Returns true if load() takes it for a path.
bool isPath(std::string_view source);

// Returns the paths of the files that the scene's file names. Does not pause the watchdog, unlike load(): for threads
// that it does not watch.
Result<std::vector<std::string>> filesNamedIn(const std::string& path);

// An inline scene, as a client sends it: may not name files. Errors carry the field path.
Result<Scene> build(const v1::Scene& message, const Overrides& overrides = {}, Progress* progress = nullptr);

// Spheres for a Spawn command. They lie inside the bounds of `scene`, clear of its obstacles and of its spheres at
// their present places; a fill finds places between them. Error paths start with "group".
Result<std::vector<Sphere>> buildGroup(const v1::Group& group, const Scene& scene, Progress* progress = nullptr);

// Returns a vector of three finite numbers, or an error with `field`.
Result<glm::dvec3> vectorOf(const google::protobuf::RepeatedField<double>& values, std::string_view field);

// Returns a box with min below max on every axis, or an error with `field`.
Result<Box> boxOf(const v1::Box& message, std::string_view field);

// Returns the substeps per step that suit the scene and its model; may exceed maxSubsteps.
double defaultSubsteps(const Scene& scene);

// Returns the names of the scenes that are part of the program, sorted.
std::vector<std::string> names();

}  // namespace spherule::scene
