#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/check.h"
#include "scene/occupancy.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// The context in which a group is read.
struct GroupContext {
    std::string field;                                 // "groups[2]"
    std::uint64_t stream = 0;                          // of random numbers; separates groups with the same seed
    std::optional<std::uint64_t> seed{};               // replaces the group's own seed
    std::optional<std::filesystem::path> directory{};  // of the scene file; nullopt: files may not be named
    std::span<const Sphere> taken{};                   // a fill avoids these spheres
    Occupancy& occupancy;                              // may hold the first of `taken`; holds all after a fill
    std::size_t room = 0;                              // spheres that the scene may still take
};

// The fields of a group that readGroup() has checked.
Look lookOf(const v1::Group& message);

// Returns the spheres of a group. Each is inside the bounds of `scene` and clear of its obstacles.
std::vector<Sphere> readGroup(Check& check, const v1::Group& message, const Scene& scene, const GroupContext& context);

// Adds the spheres of `taken` that `occupancy` lacks; it must hold the first of them. Returns false if cancelled.
bool addTaken(Check& check, std::span<const Sphere> taken, Occupancy& occupancy);

}  // namespace spherule::scene
