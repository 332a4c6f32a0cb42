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

// Where a group is read for.
struct GroupContext {
    std::string field;                                 // "groups[2]"
    std::uint64_t stream = 0;                          // of random numbers; groups with one seed differ in it
    std::optional<std::uint64_t> seed{};               // in place of the group's own
    std::optional<std::filesystem::path> directory{};  // of the scene file; none: files may not be named
    std::span<const Sphere> taken{};                   // a fill keeps clear of these;
    Occupancy& occupancy;                              // it may hold the first of them, and holds all after a fill
    std::size_t room = 0;                              // spheres that the scene may still take
};

// Spheres of a group: each inside the bounds of `scene`, clear of its obstacles.
std::vector<Sphere> readGroup(Check& check, const v1::Group& message, const Scene& scene, const GroupContext& context);

// Adds the spheres of `taken` that `occupancy` lacks; it holds the first of them. Returns false if cancelled.
bool addTaken(Check& check, std::span<const Sphere> taken, Occupancy& occupancy);

}  // namespace spherule::scene
