#include "scene/part_changes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <spdlog/fmt/fmt.h>

#include "scene/emitters.h"
#include "scene/group.h"
#include "scene/load.h"
#include "scene/materials.h"
#include "scene/periodic_axes.h"
#include "scene/quality.h"
#include "scene/surroundings.h"
#include "spherule/v1/scene_parts.pb.h"

namespace spherule::scene {

namespace {

using Part = PartChange::Part;
using Kind = PartChange::Kind;

// Refuses a change that makes a step take very long: everybody who watches would wait. `before`: the substeps before.
void checkCost(Check& check, const Scene& scene, std::uint32_t before) {
    constexpr double mostGrowth = 8;
    const double most = std::max(mostGrowth * before, std::floor(substepsOfTenSeconds(scene)));
    if (scene.quality.substeps > most)
        check.refuse("quality.substeps",
                     fmt::format("would rise from {} to {}, and a step would take minutes; at most {:.0f} are allowed: "
                                 "make springs, liquids or materials softer, or spheres heavier",
                                 before, scene.quality.substeps, most),
                     Cause::TooManySubsteps, {.least = {}, .most = most});
}

// Refuses a scene that does not hold together any more, as buildIn() does. Chooses the substeps.
Result<PartChange> checked(Scene& scene, const PartChange& change) {
    Check check;
    const std::uint32_t before = scene.quality.substeps;
    if (const double smallest = smallestRadiusIn(scene); smallest > 0)
        checkResolution(check, scene, smallest, "bounds");
    for (const auto& fits : {checkPeriodicAxes(scene), checkLiquids(scene), checkModel(scene), fitSubsteps(scene)})
        if (check.ok() && !fits) check.refuse(fits.error());
    if (check.ok()) checkCost(check, scene, before);
    if (check.ok()) checkEmitterSpeeds(check, scene);
    if (check.ok())
        if (const auto fits = checkObstacleSpeeds(scene); !fits) check.refuse(fits.error());
    if (!check.ok()) return check.error();
    return change;
}

Result<PartChange> checked(const Check& check, Scene& scene, const PartChange& change) {
    if (!check.ok()) return check.error();
    return checked(scene, change);
}

void checkRoom(Check& check, std::size_t count, std::size_t most, const char* field) {
    if (count >= most) check.refuse(field, fmt::format("is one too many, a scene has at most {}", most));
}

template <class Value>
void erase(std::vector<Value>& values, std::uint32_t number) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(number));
}

PartChange last(Part part, std::size_t count) {
    return {part, Kind::Added, static_cast<std::uint32_t>(count - 1)};
}

}  // namespace

Result<void> checkNumber(std::uint32_t number, std::size_t count, const char* of) {
    if (number < count) return {};
    return fail(ErrorKind::Refused, "number",
                count == 0 ? fmt::format("is not there: the scene has no {}", of)
                           : fmt::format("is {}, must be 0 to {}", number, count - 1),
                Cause::Range);
}

// Fields.

Result<PartChange> changePart(Scene& scene, const v1::AddField& message) {
    Check check;
    std::vector<Field>& fields = scene.forces.fields;
    checkRoom(check, fields.size(), maxFields, "field");
    auto field = readField(check, message.field(), "field");
    if (field) fields.push_back(std::move(*field));
    return checked(check, scene, last(Part::Fields, fields.size()));
}

Result<PartChange> changePart(Scene& scene, const v1::ChangeField& message) {
    std::vector<Field>& fields = scene.forces.fields;
    if (auto right = checkNumber(message.number(), fields.size(), "fields"); !right)
        return tl::unexpected(right.error());
    Check check;
    auto field = readField(check, message.field(), "field");
    if (field) fields[message.number()] = std::move(*field);
    return checked(check, scene, {Part::Fields, Kind::Changed, message.number()});
}

Result<PartChange> changePart(Scene& scene, const v1::RemoveField& message) {
    std::vector<Field>& fields = scene.forces.fields;
    if (auto right = checkNumber(message.number(), fields.size(), "fields"); !right)
        return tl::unexpected(right.error());
    erase(fields, message.number());
    return checked(scene, {Part::Fields, Kind::Removed, message.number()});
}

// Emitters.

namespace {

// Returns the first stream of random numbers that no emitter has.
std::uint64_t freeStream(const Scene& scene) {
    std::uint64_t stream = 0;
    while (std::ranges::find(scene.emitters, stream, &Emitter::stream) != scene.emitters.end()) ++stream;
    return stream;
}

// Makes room for a group.
void makeGroupRoom(Check& check, Scene& scene, const char* field) {
    if (scene.groups.size() >= maxGroups) removeEmptyGroups(scene);
    if (scene.groups.size() >= maxGroups)
        check.refuse(field, fmt::format("needs a group, and groups and emitters are at most {}", maxGroups));
}

void setGroup(Emitter& emitter, std::size_t group) {
    emitter.group = static_cast<std::uint16_t>(group);
    for (Sphere& sample : emitter.samples) sample.group = emitter.group;
}

}  // namespace

Result<PartChange> changePart(Scene& scene, const v1::AddEmitter& message) {
    Check check;
    checkRoom(check, scene.emitters.size(), maxEmitters, "emitter");
    makeGroupRoom(check, scene, "emitter");
    if (!check.ok()) return check.error();
    const auto group = static_cast<std::uint16_t>(scene.groups.size());
    Emitter emitter =
        readEmitter(check, message.emitter(),
                    {.field = "emitter", .stream = freeStream(scene), .group = group, .origin = scene.time}, scene);
    scene.groups.push_back(groupFor(check, message.emitter(), emitter, "emitter"));
    if (!check.ok()) return check.error();
    scene.emitters.push_back(std::move(emitter));
    checkBirths(check, scene, "emitter");
    return checked(check, scene, last(Part::Emitters, scene.emitters.size()));
}

Result<PartChange> changePart(Scene& scene, const v1::ChangeEmitter& message) {
    if (auto right = checkNumber(message.number(), scene.emitters.size(), "emitters"); !right)
        return tl::unexpected(right.error());
    Check check;
    const Emitter& before = scene.emitters[message.number()];
    const std::uint16_t own = before.group;
    Emitter emitter =
        readEmitter(check, message.emitter(),
                    {.field = "emitter", .stream = before.stream, .group = own, .origin = before.origin}, scene);
    Group group = groupFor(check, message.emitter(), emitter, "emitter");
    if (!check.ok()) return check.error();
    // The spheres that it has made stay as they are.
    if (scene.groups[own].count == 0) {
        scene.groups[own] = std::move(group);
    } else if (!sameGroup(scene.groups[own], group)) {
        makeGroupRoom(check, scene, "emitter");
        setGroup(emitter, scene.groups.size());
        scene.groups.push_back(std::move(group));
    }
    scene.emitters[message.number()] = std::move(emitter);
    checkBirths(check, scene, "emitter");
    return checked(check, scene, {Part::Emitters, Kind::Changed, message.number()});
}

Result<PartChange> changePart(Scene& scene, const v1::RemoveEmitter& message) {
    if (auto right = checkNumber(message.number(), scene.emitters.size(), "emitters"); !right)
        return tl::unexpected(right.error());
    const std::size_t group = scene.emitters[message.number()].group;
    erase(scene.emitters, message.number());
    if (scene.groups[group].count == 0) removeGroup(scene, group);
    return checked(scene, {Part::Emitters, Kind::Removed, message.number()});
}

// Materials.

namespace {

// Checks and updates the emitters of a material that has changed.
void updateEmitters(Check& check, Scene& scene, std::size_t material) {
    for (std::size_t k = 0; k < scene.emitters.size() && check.ok(); ++k) {
        Emitter& emitter = scene.emitters[k];
        if (emitter.material != material) continue;
        useMaterial(check, emitter, scene, at("emitters", k));
        checkBirths(check, scene, at("emitters", k));
        if (emitter.message->material() == scene.materials[material].name) continue;
        v1::Emitter renamed = *emitter.message;
        renamed.set_material(scene.materials[material].name);
        emitter.message = std::make_shared<const v1::Emitter>(std::move(renamed));
    }
}

// Returns what is of a material, for users; empty if nothing is.
std::string usersOf(const Scene& scene, std::size_t material) {
    constexpr std::size_t mostNamed = 5;
    std::vector<std::string> users;
    const auto look = [&](const auto& parts, const char* list, auto isOne) {
        for (std::size_t k = 0; k < parts.size(); ++k)
            if (parts[k].material == material && isOne(parts[k])) users.push_back(at(list, k));
    };
    if (scene.bounds.material == material && hasWalls(scene)) users.emplace_back("the walls");
    look(scene.groups, "groups", [](const Group& group) { return group.count > 0; });
    look(scene.emitters, "emitters", [](const Emitter&) { return true; });
    look(scene.obstacles, "obstacles", [](const Obstacle&) { return true; });
    if (users.size() <= mostNamed) return fmt::format("{}", fmt::join(users, ", "));
    const std::size_t more = users.size() - mostNamed;
    users.resize(mostNamed);
    return fmt::format("{} and {} more", fmt::join(users, ", "), more);
}

// Refuses a material without a name that pairs name: a scene file could not.
void checkPairsName(Check& check, const Scene& scene, std::size_t material) {
    if (!scene.materials[material].name.empty()) return;
    for (std::size_t k = 0; k < scene.pairs.size() && check.ok(); ++k)
        if (scene.pairs[k].a == material || scene.pairs[k].b == material)
            check.refuse("material.name", fmt::format("is empty, but {} is of this material; give it a name, or remove "
                                                      "the pair first",
                                                      at("pairs", k)));
}

// Gives the materials behind `gone` their new numbers.
void renumber(std::uint8_t& material, std::size_t gone) {
    if (material == gone)
        material = 0;  // of walls that do not exist, and of groups without spheres
    else if (material > gone)
        --material;
}

}  // namespace

Result<PartChange> changePart(Scene& scene, const v1::AddMaterial& message) {
    Check check;
    checkRoom(check, scene.materials.size(), maxMaterials, "material");
    Material material = readMaterial(check, message.material(), scene.materials, false, "material");
    scene.materials.push_back(std::move(material));
    return checked(check, scene, last(Part::Materials, scene.materials.size()));
}

Result<PartChange> changePart(Scene& scene, const v1::ChangeMaterial& message) {
    const std::uint32_t number = message.number();
    if (auto right = checkNumber(number, scene.materials.size(), "materials"); !right)
        return tl::unexpected(right.error());
    Check check;
    std::vector<Material> others = scene.materials;
    erase(others, number);
    scene.materials[number] = readMaterial(check, message.material(), others, number == 0, "material");
    if (check.ok()) checkPairsName(check, scene, number);
    if (check.ok()) updateEmitters(check, scene, number);
    return checked(check, scene, {Part::Materials, Kind::Changed, number});
}

Result<PartChange> changePart(Scene& scene, const v1::RemoveMaterial& message) {
    const std::uint32_t number = message.number();
    if (auto right = checkNumber(number, scene.materials.size(), "materials"); !right)
        return tl::unexpected(right.error());
    if (scene.materials.size() == 1) return fail(ErrorKind::Refused, "number", "is of the only material");
    if (const std::string users = usersOf(scene, number); !users.empty())
        return fail(ErrorKind::Refused, "number",
                    fmt::format("is of the material {}, of which are {}; remove these, or change their material",
                                shown(scene.materials[number].name), users));
    erase(scene.materials, number);
    std::erase_if(scene.pairs, [&](const MaterialPair& pair) { return pair.a == number || pair.b == number; });
    renumber(scene.bounds.material, number);
    const auto renumberAll = [&](auto& parts) {
        for (auto& part : parts) renumber(part.material, number);
    };
    renumberAll(scene.groups);
    renumberAll(scene.obstacles);
    renumberAll(scene.spheres);
    renumberAll(scene.emitters);
    for (Emitter& emitter : scene.emitters) renumberAll(emitter.samples);
    for (MaterialPair& pair : scene.pairs) {
        renumber(pair.a, number);
        renumber(pair.b, number);
    }
    return checked(scene, {Part::Materials, Kind::Removed, number});
}

Result<PartChange> changePart(Scene& scene, const v1::SetPair& message) {
    Check check;
    const MaterialPair pair = readPair(check, message.pair(), scene.materials, "pair");
    if (!check.ok()) return check.error();
    const auto before = std::ranges::find_if(scene.pairs, [&](const MaterialPair& one) { return samePair(one, pair); });
    const auto number = static_cast<std::uint32_t>(before - scene.pairs.begin());
    const bool there = before != scene.pairs.end();
    if (!pair.restitution && !pair.friction && !pair.rollingResistance && !pair.spinningResistance) {
        if (!there) return fail(ErrorKind::Refused, "pair", "has no values that could be removed; give some");
        scene.pairs.erase(before);
        return checked(scene, {Part::Pairs, Kind::Removed, number});
    }
    if (there)
        *before = pair;
    else
        scene.pairs.push_back(pair);
    return checked(scene, {Part::Pairs, there ? Kind::Changed : Kind::Added, number});
}

// Groups.

namespace {

// Gives the emitter of a group the name and the look of the group.
void takeLook(Emitter& emitter, const Group& group) {
    v1::Emitter message = *emitter.message;
    emitter.name = group.name;
    message.set_name(group.name);
    message.set_colour(group.look.colour);
    message.set_roughness(group.look.roughness);
    message.set_metal(group.look.metal);
    emitter.message = std::make_shared<const v1::Emitter>(std::move(message));
}

}  // namespace

bool sameGroup(const Group& one, const Group& other) {
    return one.name == other.name && one.material == other.material && one.fixed == other.fixed &&
           one.look.colour == other.look.colour && one.look.roughness == other.look.roughness &&
           one.look.metal == other.look.metal;
}

std::optional<std::size_t> emitterOf(const Scene& scene, std::size_t group) {
    const auto found = std::ranges::find(scene.emitters, group, &Emitter::group);
    if (found == scene.emitters.end()) return std::nullopt;
    return static_cast<std::size_t>(found - scene.emitters.begin());
}

Result<PartChange> changePart(Scene& scene, const v1::ChangeGroup& message) {
    const std::uint32_t number = message.number();
    if (auto right = checkNumber(number, scene.groups.size(), "groups"); !right) return tl::unexpected(right.error());
    Check check;
    Group& group = scene.groups[number];
    const auto emitter = emitterOf(scene, number);
    if (message.has_name()) {
        checkName(check, message.name(), "name");
        group.name = message.name();
    }
    if (message.has_colour()) group.look.colour = check.colour(message.colour(), "colour");
    if (message.has_roughness()) group.look.roughness = check.within(message.roughness(), 0, 1, "roughness");
    if (message.has_metal()) group.look.metal = check.within(message.metal(), 0, 1, "metal");
    if (message.has_material()) {
        const std::uint8_t material = materialNamed(check, message.material(), scene.materials, "material");
        if (check.ok() && emitter && material != group.material)
            check.refuse("material",
                         fmt::format("is the one of {}, which makes the spheres of this group; change the emitter",
                                     at("emitters", *emitter)));
        group.material = material;
        for (Sphere& sphere : scene.spheres)
            if (sphere.group == number) sphere.material = material;
    }
    if (emitter) takeLook(scene.emitters[*emitter], group);
    return checked(check, scene, {Part::Groups, Kind::Changed, number});
}

void removeGroup(Scene& scene, std::size_t number) {
    scene.groups.erase(scene.groups.begin() + static_cast<std::ptrdiff_t>(number));
    const auto renumbered = [&](std::uint16_t& group) { group -= group > number ? 1 : 0; };
    for (Sphere& sphere : scene.spheres) renumbered(sphere.group);
    for (Emitter& emitter : scene.emitters) {
        renumbered(emitter.group);
        for (Sphere& sample : emitter.samples) renumbered(sample.group);
    }
}

}  // namespace spherule::scene
