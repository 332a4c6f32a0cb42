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
    bool placesFills = true;                           // false: a fill is not placed
};

// Reads the look of a v1::Group or a v1::Emitter.
template <class Message>
Look readLook(Check& check, const Message& message, std::string_view field) {
    Look look{.colour = check.colour(message.colour(), at(field, "colour"))};
    if (message.has_roughness()) look.roughness = check.within(message.roughness(), 0, 1, at(field, "roughness"));
    look.metal = check.within(message.metal(), 0, 1, at(field, "metal"));
    return look;
}

// Refuses a name that is too long.
void checkName(Check& check, const std::string& name, std::string_view field);

// Returns the spheres of a group. Each is inside the bounds of `scene` and clear of its obstacles.
std::vector<Sphere> readGroup(Check& check, const v1::Group& message, const Scene& scene, const GroupContext& context);

// Returns the group of these spheres, which are of one material.
Group groupOf(std::span<const Sphere> spheres, std::string name, Look look);

// Adds the spheres of `taken` that `occupancy` lacks; it must hold the first of them. Returns false if cancelled.
bool addTaken(Check& check, std::span<const Sphere> taken, Occupancy& occupancy);

}  // namespace spherule::scene
