#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/memory.h"
#include "scene/check.h"
#include "scene/occupancy.h"
#include "scene/radii.h"
#include "scene/random.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// The input of a group's sources. The spheres they return have position, velocity, spin and radius;
// the material, and the check that each sphere has a place in the scene, are the group's.
struct SourceInput {
    std::string field;             // of the source: "groups[2].lattice"
    std::optional<Radii> radii{};  // of the group
    glm::vec3 velocity{};          // m/s, of the group
    glm::vec3 spin{};              // rad/s, of the group
    std::size_t room = 0;          // spheres that the scene may still take
    Random random;
};

// For `count` spheres that a source makes, and `besides` (bytes) for each of them, until they are there. Nothing, and
// refused, when they are more than the scene has room for, or than memory has.
std::optional<memory::Claim> checkRoom(Check& check, const SourceInput& input, double count, std::string_view field,
                                       std::size_t besides = 0);

// The group's radii; refused when it has none.
Radii requiredRadii(Check& check, const SourceInput& input);

std::vector<Sphere> fromList(Check& check, const v1::List& list, SourceInput input);

std::vector<Sphere> fromLattice(Check& check, const v1::Lattice& lattice, SourceInput input);

// Reads `directory`/list.file(). Places in the file are reported as file:line:column.
std::vector<Sphere> fromCsv(Check& check, const v1::Csv& csv, const std::filesystem::path& directory,
                            SourceInput input);

// Clear of `obstacles` and of `taken`, to which they are added. Gives up, and refuses, when free places become too hard
// to find.
std::vector<Sphere> fromFill(Check& check, const v1::Fill& fill, const std::vector<Obstacle>& obstacles,
                             Occupancy& taken, SourceInput input);

}  // namespace spherule::scene
