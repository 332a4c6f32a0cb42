#include "scene/build.h"

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/memory.h"
#include "scene/emitters.h"
#include "scene/group.h"
#include "scene/materials.h"
#include "scene/occupancy.h"
#include "scene/periodic_axes.h"
#include "scene/quality.h"
#include "scene/radius_distribution.h"
#include "scene/shapes.h"
#include "scene/surroundings.h"
#include "scene/view.h"

namespace spherule::scene {

namespace {

double smallestRadiusOf(const std::vector<Sphere>& spheres) {
    return static_cast<double>(std::ranges::min_element(spheres, {}, &Sphere::radius)->radius);
}

// Returns the largest radius that the group draws; smallestRadius if it has no distribution of radii. Ignores errors:
// readGroup() reports them.
double largestRadiusOf(const v1::Group& group) {
    Check check;
    return group.has_radius() ? std::max(smallestRadius, readRadiusDistribution(check, group.radius(), "").max)
                              : smallestRadius;
}

void append(Check& check, std::vector<Sphere>& all, std::vector<Sphere> spheres) {
    if (all.empty()) {
        all = std::move(spheres);
        return;
    }
    const std::size_t count = all.size() + spheres.size();
    const auto room = memory::Claim::make("groups", fmt::format("{} spheres in a scene", count),
                                          count > all.capacity() ? count * sizeof(Sphere) : 0);
    if (!room) return check.refuse(room.error());
    all.insert(all.end(), spheres.begin(), spheres.end());
}

constexpr std::size_t mostJammed = 3;  // fills without room, which take the longest

void readGroups(Check& check, const v1::Scene& message, const std::optional<std::filesystem::path>& directory,
                const Overrides& overrides, Scene& scene) {
    if (static_cast<std::uint32_t>(message.groups_size()) > maxGroups)
        return check.refuse("groups",
                            fmt::format("has {} entries, must have at most {}", message.groups_size(), maxGroups));
    double largest = smallestRadius;
    for (const v1::Group& group : message.groups()) largest = std::max(largest, largestRadiusOf(group));
    Occupancy occupancy(largest, scene.bounds);
    std::size_t jammed = 0;
    const auto count = static_cast<std::size_t>(message.groups_size());
    check.entries("groups", count, [&](std::size_t i, const std::string& field) {
        const v1::Group& group = message.groups(static_cast<int>(i));
        const auto first = static_cast<std::uint32_t>(scene.spheres.size());
        std::vector<Sphere> spheres = readGroup(check, group, scene,
                                                {.field = field,
                                                 .stream = i,
                                                 .seed = overrides.seed,
                                                 .directory = directory,
                                                 .taken = scene.spheres,
                                                 .occupancy = occupancy,
                                                 .room = maxSpheres - first,
                                                 .placesFills = jammed < mostJammed});
        if (group.has_fill() && !check.ok() && check.lastCause() == Cause::NoRoom) ++jammed;
        scene.groups.push_back(groupOf(spheres, group.name(), readLook(check, group, field)));
        // The occupancy has the spheres of a fill already.
        if (check.ok() || group.has_fill()) append(check, scene.spheres, std::move(spheres));
    });
}

Box readRegion(Check& check, const v1::Box& message, std::string_view field) {
    check.part([&] {
        if (message.hollow()) check.refuse(at(field, "hollow"), "is true; only the boxes of obstacles may be hollow");
    });
    return check.box(message.min(), message.max(), field);
}

std::vector<Box> readSinks(Check& check, const v1::Scene& message) {
    std::vector<Box> sinks;
    const auto count = static_cast<std::size_t>(message.sinks_size());
    if (count > maxSinks) {
        check.refuse("sinks", fmt::format("has {} entries, must have at most {}", count, maxSinks));
        return sinks;
    }
    check.entries("sinks", count, [&](std::size_t k, const std::string& entry) {
        const std::string field = at(entry, "region");
        const v1::Sink& sink = message.sinks(static_cast<int>(k));
        if (!sink.has_region()) return check.refuse(field, "is missing; give min and max");
        sinks.push_back(readRegion(check, sink.region(), field));
    });
    return sinks;
}

Sleep readSleep(Check& check, const v1::Sleep& message, bool noSleep) {
    Sleep sleep;
    if (message.has_enabled()) sleep.enabled = message.enabled();
    if (message.has_speed()) sleep.speed = check.upTo(message.speed(), 1000, "sleep.speed", " m/s");
    if (message.has_time()) sleep.time = check.upTo(message.time(), 3600, "sleep.time", " s");
    if (noSleep) sleep.enabled = false;
    return sleep;
}

void readText(Check& check, const std::string& text, std::size_t longest, const char* field) {
    check.part([&] {
        if (text.size() > longest)
            check.refuse(field, fmt::format("is {} bytes long, must be at most {}", text.size(), longest));
    });
}

// Reads the parts that depend on no others but the materials.
void readOwnParts(Check& check, const v1::Scene& message, const Overrides& overrides, Scene& scene) {
    readText(check, message.name(), longestName, "name");
    scene.name = message.name();
    scene.description = message.description();
    readText(check, message.what_to_try(), longestAdvice, "whatToTry");
    scene.whatToTry = message.what_to_try();
    scene.forces.gravity = check.vectorOr(message.gravity(), {0, 0, -9.81}, "gravity");
    check.part([&] { scene.forces.fields = readFields(check, message); });
    check.part([&] { scene.materials = readMaterials(check, message.materials()); });
    check.part([&] { scene.pairs = readPairs(check, message.pairs(), scene.materials); });
    if (message.has_step()) scene.step = check.within(message.step(), 1e-6, 1, "step", " s");
    if (message.has_sphere_contacts()) scene.sphereContacts = message.sphere_contacts();
    scene.contactSums = message.contact_sums() || overrides.contactSums;
    check.part([&] { scene.sinks = readSinks(check, message); });
    scene.sleep = readSleep(check, message.sleep(), overrides.noSleep);
    if (message.has_light()) check.part([&] { scene.light = readLight(check, message.light()); });
}

// Reads what is in the bounds.
void readContent(Check& check, const v1::Scene& message, const std::optional<std::filesystem::path>& directory,
                 const Overrides& overrides, Scene& scene) {
    const bool known = areBoundsKnown(check);
    const glm::dvec3 sides = scene.bounds.max - scene.bounds.min;
    check.part([&] {
        scene.obstacles = readObstacles(check, message.obstacles(), scene.materials,
                                        {.directory = directory, .longestSide = std::max({sides.x, sides.y, sides.z})});
    });
    if (known) check.part([&] { scene.camera = readCamera(check, message.camera(), scene.bounds); });
    check.part([&] { readGroups(check, message, directory, overrides, scene); });
    check.part([&] { readEmitters(check, message, overrides.seed, scene); });
}

// Checks whether the parts of a scene without errors fit each other, and chooses the substeps.
void checkTogether(Check& check, const v1::Scene& message, const Overrides& overrides, Scene& scene) {
    if (const double smallest = smallestRadiusIn(scene); smallest > 0)
        checkResolution(check, scene, smallest, "bounds");
    if (check.ok())
        if (const auto fits = checkPeriodicAxes(scene); !fits) check.refuse(fits.error());
    if (check.ok()) readQuality(check, message.quality(), overrides, scene);
    if (check.ok()) checkEmitterSpeeds(check, scene);
}

Scene readScene(Check& check, const std::optional<std::filesystem::path>& directory, const v1::Scene& message,
                const Overrides& overrides) {
    Scene scene;
    readOwnParts(check, message, overrides, scene);
    check.part([&] {
        if (!message.has_bounds()) return check.refuse("bounds", "are missing; give min and max");
        scene.bounds = readBounds(check, message.bounds(), scene.materials, "bounds");
    });
    readContent(check, message, directory, overrides, scene);
    if (check.isRight("gravity") && check.isRight("bounds.periodic"))
        check.part([&] {
            if (const auto rests = checkLiquids(scene); !rests) check.refuse(rests.error());
        });
    if (check.isRight()) checkTogether(check, message, overrides, scene);
    return scene;
}

}  // namespace

Result<Scene> buildIn(const std::optional<std::filesystem::path>& directory, const v1::Scene& message,
                      const Overrides& overrides, Progress* progress) {
    Check check(progress);
    Scene scene = readScene(check, directory, message, overrides);
    if (!check.ok()) return check.error();
    return scene;
}

std::vector<Error> errorsIn(const std::optional<std::filesystem::path>& directory, const v1::Scene& message,
                            std::vector<std::string> doubts) {
    Check check(nullptr, Check::Keep::All);
    for (std::string& doubt : doubts) check.doubt(std::move(doubt));
    readScene(check, directory, message, {});
    return check.errors();
}

Result<Scene> build(const v1::Scene& message, const Overrides& overrides, Progress* progress) {
    return buildIn(std::nullopt, message, overrides, progress);
}

namespace {

// Refuses the first sphere of `added` that overlaps a sphere of `taken`.
void checkFree(Check& check, const std::vector<Sphere>& added, const std::vector<Sphere>& taken, Occupancy& occupied) {
    constexpr std::uint64_t mostWork = 4'000'000'000;  // about ten seconds
    if (!addTaken(check, taken, occupied)) return;
    for (std::size_t k = 0; k < added.size() && check.goesOn("comparing places", k, added.size()); ++k) {
        const glm::dvec3& p = added[k].position;
        if (!occupied.isFree(p, static_cast<double>(added[k].radius)))
            check.refuse("group", fmt::format("sphere {} at {:g} {:g} {:g} overlaps one that is there already", k, p.x,
                                              p.y, p.z));
        if (occupied.work() > mostWork)
            check.refuse("group", "is too much to compare with all that is there already; add it in parts");
    }
}

}  // namespace

Result<std::vector<Sphere>> buildGroup(const v1::Group& group, const Scene& scene, Progress* progress) {
    Check check(progress);
    const std::size_t room = maxSpheres - std::min<std::size_t>(maxSpheres, scene.spheres.size());
    if (scene.groups.size() >= maxGroups)
        return fail(ErrorKind::Input, "group", fmt::format("is one too many, a scene has at most {}", maxGroups));
    double largest = largestRadiusOf(group);
    for (const Sphere& sphere : scene.spheres) largest = std::max(largest, static_cast<double>(sphere.radius));
    Occupancy occupancy(largest, scene.bounds);
    std::vector<Sphere> spheres = readGroup(
        check, group, scene, {.field = "group", .taken = scene.spheres, .occupancy = occupancy, .room = room});
    if (check.ok() && !group.has_fill()) checkFree(check, spheres, scene.spheres, occupancy);
    if (check.ok() && !spheres.empty()) checkResolution(check, scene, smallestRadiusOf(spheres), "group.radius");
    if (!check.ok()) return check.error();
    return spheres;
}

Result<glm::dvec3> vectorOf(const Numbers& values, std::string_view field) {
    Check check;
    const glm::dvec3 result = check.vector(values, field);
    if (!check.ok()) return check.error();
    return result;
}

Result<Box> boxOf(const v1::Box& message, std::string_view field) {
    Check check;
    const Box box = readRegion(check, message, field);
    if (!check.ok()) return check.error();
    return box;
}

}  // namespace spherule::scene
