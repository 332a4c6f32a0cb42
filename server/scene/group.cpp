#include "scene/group.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

#include "scene/load.h"
#include "scene/materials.h"
#include "scene/source.h"
#include "scene/surroundings.h"

namespace spherule::scene {

namespace {

// Returns the source's name in the scene file; empty if there is none.
std::string sourceName(const v1::Group& message) {
    switch (message.source_case()) {
        case v1::Group::kList:
            return "list";
        case v1::Group::kLattice:
            return "lattice";
        case v1::Group::kFill:
            return "fill";
        case v1::Group::kCsv:
            return "csv";
        case v1::Group::kXyz:
            return "xyz";
        case v1::Group::kLammps:
            return "lammps";
        case v1::Group::SOURCE_NOT_SET:
            break;
    }
    return "";
}

std::uint64_t seedOf(const v1::Group& message) {
    constexpr std::uint64_t absent = 1;
    if (message.has_lattice() && message.lattice().has_seed()) return message.lattice().seed();
    if (message.has_fill() && message.fill().has_seed()) return message.fill().seed();
    return absent;
}

// Returns the file that the source names; nullptr if the source is no file.
const std::string* fileOf(const v1::Group& message) {
    if (message.has_csv()) return &message.csv().file();
    if (message.has_xyz()) return &message.xyz().file();
    if (message.has_lammps()) return &message.lammps().file();
    return nullptr;
}

std::vector<Sphere> fromFile(Check& check, const v1::Group& message, const GroupContext& context, SourceInput input,
                             FileLines& lines) {
    if (!context.directory) {
        check.refuse(input.field, fmt::format("names the file {}, but only a scene file may name files; give the "
                                              "spheres as a list",
                                              shown(*fileOf(message))));
        return {};
    }
    if (message.has_csv()) return fromCsv(check, message.csv(), *context.directory, std::move(input), lines);
    if (message.has_xyz()) return fromXyz(check, message.xyz(), *context.directory, std::move(input), lines);
    return fromLammps(check, message.lammps(), *context.directory, std::move(input), lines);
}

double longestSide(const Bounds& bounds) {
    const glm::dvec3 side = bounds.max - bounds.min;
    return std::max({side.x, side.y, side.z});
}

// A group as it is read, for refusals of its spheres.
struct ReadGroup {
    const v1::Group& message;
    const std::string& source;  // field of the source
    std::vector<Sphere> spheres{};
    FileLines lines{};                 // of a file's spheres
    std::vector<std::size_t> wrong{};  // numbers of refused spheres of a list, in order
};

std::vector<Sphere> fromSource(Check& check, ReadGroup& group, const Scene& scene, const GroupContext& context,
                               SourceInput input) {
    const v1::Group& message = group.message;
    switch (message.source_case()) {
        case v1::Group::kList:
            return fromList(check, message.list(), std::move(input), group.wrong);
        case v1::Group::kLattice:
            return fromLattice(check, message.lattice(), scene.bounds, std::move(input));
        case v1::Group::kFill:
            if (!addTaken(check, context.taken, context.occupancy)) return {};
            return fromFill(check, message.fill(),
                            {.directory = context.directory, .longestSide = longestSide(scene.bounds)}, scene,
                            context.occupancy, std::move(input));
        case v1::Group::kCsv:
        case v1::Group::kXyz:
        case v1::Group::kLammps:
            return fromFile(check, message, context, std::move(input), group.lines);
        case v1::Group::SOURCE_NOT_SET:
            check.refuse(context.field, "has no spheres, must have one of list, lattice, fill, csv, xyz, lammps");
            break;
    }
    return {};
}

// Refuses sphere `index`, with its place in the scene or its file.
void refuseSphere(Check& check, const ReadGroup& group, std::size_t index, const std::string& reason) {
    const Sphere& sphere = group.spheres[index];
    const std::string what = fmt::format("at {} with radius {}", shown(sphere.position), sphere.radius);
    if (group.message.has_list()) {
        check.refuse(at(at(group.source, "spheres"), index), fmt::format("is {} and {}", what, reason));
    } else if (const std::string* file = fileOf(group.message)) {
        check.refuse(at(group.source, "file"),
                     fmt::format("{}:{}:1: the sphere {} {}", *file, group.lines[index], what, reason));
    } else {
        check.refuse(group.source, fmt::format("puts a sphere {}, which {}", what, reason));
    }
}

// Refuses too many pairs of a sphere and an obstacle: each pair is tested here once, and then in every substep.
void checkWork(Check& check, const Scene& scene, const std::string& source, std::size_t spheres) {
    const std::size_t pairs = spheres * scene.obstacles.size();
    if (pairs <= maxObstaclePairs) return;
    check.refuse(source,
                 fmt::format("makes {} spheres in all, {} pairs with the {} obstacles, but a scene holds at most "
                             "{}; use fewer of one or the other",
                             spheres, pairs, scene.obstacles.size(), maxObstaclePairs),
                 Cause::NoRoom);
}

constexpr std::size_t betweenMarks = 1024;  // spheres

// Refuses spheres that have no place: the first one, or the first ones of a list.
void checkPlaces(Check& check, const ReadGroup& group, const Scene& scene) {
    const std::vector<Sphere>& spheres = group.spheres;
    const std::size_t most = group.message.has_list() ? mostWrongSpheres : 1;
    std::size_t refused = group.wrong.size();
    for (std::size_t i = 0; i < spheres.size() && refused < most; ++i) {
        if (i % betweenMarks == 0 && !check.part([&] { check.goesOn("checking places", i, spheres.size()); })) return;
        if (std::ranges::binary_search(group.wrong, i)) continue;
        const auto radius = static_cast<double>(spheres[i].radius);
        std::optional<std::string> reason = whyOutside(scene.bounds, spheres[i].position, radius);
        if (const auto hit = obstacleAt(scene, spheres[i].position, radius); !reason && hit) {
            reason = fmt::format("reaches into {}", at("obstacles", *hit));
        }
        if (!reason) continue;
        check.part([&] { refuseSphere(check, group, i, *reason); });
        ++refused;
    }
}

// Refuses fixed spheres that move.
void checkAtRest(Check& check, const ReadGroup& group) {
    const auto moves = [](const Sphere& sphere) {
        return sphere.velocity != glm::vec3(0) || sphere.spin != glm::vec3(0);
    };
    const auto mover = std::ranges::find_if(group.spheres, moves);
    if (mover == group.spheres.end()) return;
    refuseSphere(check, group, static_cast<std::size_t>(mover - group.spheres.begin()),
                 "is fixed, so it can have neither velocity nor spin; leave these out, or leave out fixed");
}

}  // namespace

bool addTaken(Check& check, std::span<const Sphere> taken, Occupancy& occupancy) {
    for (std::size_t k = occupancy.size(); k < taken.size(); ++k) {
        if (k % betweenMarks == 0 && !check.goesOn("sorting the spheres that are there", k, taken.size())) return false;
        occupancy.add(taken[k].position, static_cast<double>(taken[k].radius));
    }
    return check.ok();
}

void checkName(Check& check, const std::string& name, std::string_view field) {
    check.part([&] {
        if (name.size() > longestName)
            check.refuse(std::string(field),
                         fmt::format("is {} bytes long, must be at most {}", name.size(), longestName));
    });
}

Group groupOf(std::span<const Sphere> spheres, std::string name, Look look) {
    Group group{.name = std::move(name), .count = static_cast<std::uint32_t>(spheres.size()), .look = std::move(look)};
    if (!spheres.empty()) {
        group.material = spheres.front().material;
        group.fixed = spheres.front().fixed;
    }
    return group;
}

namespace {

// Reads the spheres, and checks that they have places in the scene.
void readSpheres(Check& check, ReadGroup& group, const Scene& scene, const GroupContext& context, SourceInput input,
                 std::uint8_t material) {
    const v1::Group& message = group.message;
    group.spheres = fromSource(check, group, scene, context, std::move(input));
    for (Sphere& sphere : group.spheres) {
        sphere.material = material;
        sphere.fixed = message.fixed();
        sphere.group = static_cast<std::uint16_t>(scene.groups.size());
    }
    if (message.fixed() && check.ok()) checkAtRest(check, group);
    if (check.ok()) checkWork(check, scene, group.source, context.taken.size() + group.spheres.size());
    if ((check.ok() || !group.wrong.empty()) && !message.list().saved()) checkPlaces(check, group, scene);
}

// Returns true if mistakes of the text may have changed where the spheres of the group are. Each sphere of a list has
// its own place.
bool arePlacesDoubtful(const Check& check, const v1::Group& message, const std::string& source) {
    return check.isDoubtful(message.has_list() ? at(source, "saved") : source);
}

}  // namespace

std::vector<Sphere> readGroup(Check& check, const v1::Group& message, const Scene& scene, const GroupContext& context) {
    const std::string source = at(context.field, sourceName(message));
    SourceInput input{.field = source,
                      .room = context.room,
                      .random = Random(context.seed.value_or(seedOf(message)), context.stream)};
    const bool drawn = !message.has_radius() || check.part([&] {
        input.radii = readRadiusDistribution(check, message.radius(), at(context.field, "radius"));
    });
    input.velocity = check.vectorOr(message.velocity(), {}, at(context.field, "velocity"));
    input.spin = check.vectorOr(message.spin(), {}, at(context.field, "spin"));
    const std::uint8_t material =
        materialNamed(check, message.material(), scene.materials, at(context.field, "material"));
    readLook(check, message, context.field);
    checkName(check, message.name(), at(context.field, "name"));
    ReadGroup group{message, source};
    const bool placed = context.placesFills || !message.has_fill();
    if (drawn && placed && areBoundsKnown(check) && !arePlacesDoubtful(check, message, source))
        check.part([&] { readSpheres(check, group, scene, context, std::move(input), material); });
    return std::move(group.spheres);
}

void removeEmptyGroups(Scene& scene) {
    std::vector<bool> kept(scene.groups.size());
    for (std::size_t k = 0; k < kept.size(); ++k) kept[k] = scene.groups[k].count > 0;
    for (const Emitter& emitter : scene.emitters) kept[emitter.group] = true;
    std::vector<std::uint16_t> numbers(kept.size());
    std::vector<Group> groups;
    for (std::size_t k = 0; k < kept.size(); ++k) {
        numbers[k] = static_cast<std::uint16_t>(groups.size());
        if (kept[k]) groups.push_back(std::move(scene.groups[k]));
    }
    scene.groups = std::move(groups);
    for (Sphere& sphere : scene.spheres) sphere.group = numbers[sphere.group];
    for (Emitter& emitter : scene.emitters) {
        emitter.group = numbers[emitter.group];
        for (Sphere& sample : emitter.samples) sample.group = emitter.group;
    }
}

void removeSpheres(Scene& scene, const std::vector<std::uint32_t>& numbers) {
    auto next = numbers.begin();
    std::uint32_t kept = 0;
    for (std::uint32_t k = 0; k < scene.spheres.size(); ++k) {
        const Sphere& sphere = scene.spheres[k];
        if (next != numbers.end() && *next == k) {
            if (sphere.group < scene.groups.size()) --scene.groups[sphere.group].count;
            ++next;
        } else {
            scene.spheres[kept++] = sphere;
        }
    }
    scene.spheres.resize(kept);
}

}  // namespace spherule::scene
