#include "scene/emitters.h"

#include <spdlog/fmt/fmt.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/group.h"
#include "scene/load.h"
#include "scene/materials.h"
#include "scene/quality.h"
#include "scene/surroundings.h"

namespace spherule::scene {

namespace {

constexpr double mostRate = 1e6;  // spheres/s
constexpr int mostSpans = 1000;
constexpr double shortestSpan = 1e-6;  // s; so a schedule repeats less often than a double can count
constexpr std::uint64_t samplesPerEmitter = 256;

EmissionRegion readBox(Check& check, const v1::Box& message, const std::string& field) {
    refuseForm(check, message.hollow(), at(field, "hollow"));
    const Box box{check.vector(message.min(), at(field, "min")), check.vector(message.max(), at(field, "max"))};
    int flat = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (box.max[axis] < box.min[axis])
            check.refuse(at(at(field, "max"), static_cast<std::size_t>(axis)),
                         fmt::format("is {}, must not be below min, which is {}", box.max[axis], box.min[axis]));
        flat += box.max[axis] == box.min[axis] ? 1 : 0;
    }
    if (flat > 1) check.refuse(field, "has no area: its min and max may be equal along one axis alone");
    return box;
}

EmissionRegion readDisc(Check& check, const v1::DiscShape& message, const std::string& field) {
    DiscRegion disc{check.vector(message.centre(), at(field, "centre")),
                    check.vector(message.normal(), at(field, "normal")),
                    check.upTo(message.radius(), largestComponent, at(field, "radius"), " m"),
                    check.within(message.hole(), 0, largestComponent, at(field, "hole"), " m")};
    if (check.ok() && !(disc.hole < disc.radius))
        check.refuse(at(field, "hole"), fmt::format("is {} m, must be below the radius, {} m", disc.hole, disc.radius));
    const double length = glm::length(disc.normal);
    if (check.ok() && !(length > 0)) check.refuse(at(field, "normal"), "has no length");
    disc.normal /= length > 0 ? length : 1;
    return disc;
}

EmissionRegion readRegion(Check& check, const v1::Emitter& message, const std::string& field) {
    switch (message.region_case()) {
        case v1::Emitter::kBox:
            return readBox(check, message.box(), at(field, "box"));
        case v1::Emitter::kSphere:
            return readBall(check, message.sphere(), at(field, "sphere"));
        case v1::Emitter::kCylinder:
            return readCylinder(check, message.cylinder(), at(field, "cylinder"));
        case v1::Emitter::kDisc:
            return readDisc(check, message.disc(), at(field, "disc"));
        case v1::Emitter::REGION_NOT_SET:
            check.refuse(field, "has no region, must have one of box, sphere, cylinder, disc");
            break;
    }
    return {};
}

void readFlow(Check& check, const v1::Emitter& message, const std::string& field, Emitter& emitter) {
    if (message.has_mass_flow())
        emitter.massFlow = check.upTo(message.mass_flow(), largestComponent, at(field, "massFlow"), " kg/s");
    else if (message.has_rate())
        emitter.rate = check.upTo(message.rate(), mostRate, at(field, "rate"), " spheres per second");
    else
        check.refuse(field, "has no flow, must have rate or massFlow");
}

void readSchedule(Check& check, const v1::Emitter& message, const std::string& field, Emitter& emitter) {
    emitter.begin = check.within(message.begin(), -largestComponent, largestComponent, at(field, "begin"), " s");
    const std::string schedule = at(field, "schedule");
    if (message.schedule_size() > mostSpans)
        return check.refuse(schedule,
                            fmt::format("has {} entries, must have at most {}", message.schedule_size(), mostSpans));
    double end = 0;
    check.entries(schedule, static_cast<std::size_t>(message.schedule_size()), [&](std::size_t k, const auto& place) {
        const v1::Span& from = message.schedule(static_cast<int>(k));
        const Span span{check.within(from.from(), 0, largestComponent, at(place, "from"), " s"),
                        check.within(from.to(), shortestSpan, largestComponent, at(place, "to"), " s")};
        if (!check.ok()) return;
        if (span.from < end)
            check.refuse(
                at(place, "from"),
                fmt::format("is {} s, but the time before it ends at {} s; give them in order", span.from, end));
        if (check.ok() && !(span.to - span.from >= shortestSpan))
            check.refuse(at(place, "to"), fmt::format("is {} s, must be at least {} s after from, which is {} s",
                                                      span.to, shortestSpan, span.from));
        emitter.schedule.push_back(span);
        end = std::max(end, span.to);
    });
    emitter.repeat = check.within(message.repeat(), 0, largestComponent, at(field, "repeat"), " s");
    if (!check.ok() || emitter.repeat == 0 || check.isDoubtful(schedule)) return;
    if (emitter.repeat < shortestSpan)
        check.refuse(at(field, "repeat"),
                     fmt::format("is {} s, must be 0 or at least {} s", emitter.repeat, shortestSpan));
    if (emitter.schedule.empty()) check.refuse(at(field, "repeat"), "needs a schedule");
    if (emitter.repeat < end)
        check.refuse(at(field, "repeat"),
                     fmt::format("is {} s, must be at least the end of the schedule, {} s", emitter.repeat, end));
}

// Makes the samples. The first two have the smallest and the largest radius.
void drawSamples(Emitter& emitter) {
    for (std::uint64_t k = 0; k < samplesPerEmitter; ++k) {
        Sphere sphere = emitter.sphere(k);
        if (k < 2) sphere.radius = static_cast<float>(k == 0 ? emitter.radii.min : emitter.radii.max);
        sphere.position = emitter.place(k, 0);
        emitter.samples.push_back(sphere);
    }
}

double meanVolume(const Emitter& emitter) {
    return emitter.meanMass() / emitter.density;
}

// Spheres per second of work, on average.
double meanRate(const Emitter& emitter) {
    return emitter.rate > 0 ? emitter.rate : emitter.massFlow / emitter.meanMass();
}

// The spheres that are present at the same time, as far as the emitter alone tells: the grid gets cells for them.
double expectedSpheres(const Emitter& emitter, const Scene& scene) {
    constexpr double minute = 60;  // s
    constexpr double packing = 0.6;
    constexpr double most = 1e6;
    const glm::dvec3 side = scene.bounds.max - scene.bounds.min;
    const double work = emitter.workedUntil(emitter.begin + minute);
    double expected = std::min(most, meanRate(emitter) * work);
    if (emitter.total) expected = std::min(expected, static_cast<double>(*emitter.total));
    expected = std::min(expected, packing * side.x * side.y * side.z / meanVolume(emitter));
    return std::max(expected, 1.0);
}

// Returns the area of a surface across its normal, and the speed along the normal (m/s); nullopt for a region with a
// volume.
struct Stream {
    double area = 0;  // m^2
    double speed = 0;
};
std::optional<Stream> streamFrom(const Emitter& emitter) {
    if (const auto* const disc = std::get_if<DiscRegion>(&emitter.region))
        return Stream{std::numbers::pi * (disc->radius * disc->radius - disc->hole * disc->hole),
                      std::abs(glm::dot(disc->normal, emitter.velocity))};
    const auto* const box = std::get_if<Box>(&emitter.region);
    if (box == nullptr) return std::nullopt;
    const glm::dvec3 side = box->max - box->min;
    for (int axis = 0; axis < 3; ++axis)
        if (side[axis] == 0)
            return Stream{side[(axis + 1) % 3] * side[(axis + 2) % 3], std::abs(emitter.velocity[axis])};
    return std::nullopt;
}

// Refuses a stream that is denser than places at random can be.
void checkStream(Check& check, const Emitter& emitter, const std::string& field) {
    constexpr double densest = 0.3;  // share of the volume that random places without overlap reach at little cost
    const auto stream = streamFrom(emitter);
    if (!stream || !(stream->speed > 0)) return;  // gravity alone takes the spheres away
    const double share = meanRate(emitter) * meanVolume(emitter) / (stream->area * stream->speed);
    if (share > densest)
        check.refuse(field,
                     fmt::format("makes a stream with spheres in {:.3g} of its volume, at most {} are allowed; lower "
                                 "the flow, or enlarge the surface or the speed",
                                 share, densest),
                     Cause::NoRoom);
}

// Refuses a region in which walls and obstacles leave no place.
void checkFreePlaces(Check& check, const Emitter& emitter, const Scene& scene, const std::string& field) {
    std::string reason;
    for (std::uint64_t k = 0; k < samplesPerEmitter; ++k)
        for (unsigned attempt = 0; attempt < Emitter::mostAttempts; ++attempt) {
            const glm::dvec3 place = emitter.place(k, attempt);
            const auto outside = whyOutside(scene.bounds, place, emitter.radii.min);
            if (!outside && !obstacleAt(scene, place, emitter.radii.min)) return;
            if (reason.empty()) reason = outside.value_or("reaches into an obstacle");
        }
    check.refuse(field, fmt::format("has no place between the walls and obstacles in {} tries; a sphere of radius {} m "
                                    "in it {}",
                                    samplesPerEmitter * Emitter::mostAttempts, emitter.radii.min, reason));
}

}  // namespace

Emitter readEmitter(Check& check, const v1::Emitter& message, const EmitterContext& context, const Scene& scene) {
    const std::string& field = context.field;
    Emitter emitter;
    emitter.stream = context.stream;
    emitter.group = context.group;
    emitter.origin = context.origin;
    checkName(check, message.name(), at(field, "name"));
    emitter.name = message.name();
    check.part([&] { emitter.region = readRegion(check, message, field); });
    check.part([&] { readFlow(check, message, field, emitter); });
    check.part([&] {
        if (!message.has_radius()) return check.refuse(at(field, "radius"), "is missing");
        emitter.radii = readRadiusDistribution(check, message.radius(), at(field, "radius"));
    });
    emitter.material = materialNamed(check, message.material(), scene.materials, at(field, "material"));
    emitter.velocity = check.vectorOr(message.velocity(), {}, at(field, "velocity"));
    emitter.velocitySpread =
        check.within(message.velocity_spread(), 0, largestComponent, at(field, "velocitySpread"), " m/s");
    emitter.spin = check.vectorOr(message.spin(), {}, at(field, "spin"));
    if (message.has_total()) {
        check.part([&] {
            if (message.total() == 0) check.refuse(at(field, "total"), "is 0, must be at least 1");
        });
        emitter.total = message.total();
    }
    if (message.has_until_choked())
        emitter.untilChoked = check.upTo(message.until_choked(), largestComponent, at(field, "untilChoked"), " s");
    if (message.has_seed()) emitter.seed = message.seed();
    emitter.message = std::make_shared<const v1::Emitter>(message);
    check.part([&] { readSchedule(check, message, field, emitter); });
    emitter.begin += context.origin;
    if (!check.ok() || !areBoundsKnown(check)) return emitter;
    drawSamples(emitter);
    useMaterial(check, emitter, scene, field);
    if (check.ok()) checkFreePlaces(check, emitter, scene, field);
    return emitter;
}

void useMaterial(Check& check, Emitter& emitter, const Scene& scene, const std::string& field) {
    emitter.density = scene.materials[emitter.material].density;
    emitter.expected = expectedSpheres(emitter, scene);
    if (check.isRight(at("materials", emitter.material))) checkStream(check, emitter, field);
}

void checkBirths(Check& check, const Scene& scene, const std::string& field) {
    double births = 0;  // in a step
    for (const Emitter& emitter : scene.emitters) births += meanRate(emitter) * scene.step;
    if (births > mostBirthsPerStep)
        check.refuse(field, fmt::format("brings the emitters to {:.6g} spheres in a step, at most {:g} are allowed; "
                                        "lower the flow, or shorten the step",
                                        births, mostBirthsPerStep));
}

Group groupFor(Check& check, const v1::Emitter& message, const Emitter& emitter, const std::string& field) {
    Group group = groupOf({}, emitter.name, readLook(check, message, field));
    group.material = emitter.material;
    return group;
}

void readEmitters(Check& check, const v1::Scene& message, std::optional<std::uint64_t> seed, Scene& scene) {
    const auto count = static_cast<std::size_t>(message.emitters_size());
    if (count > maxEmitters)
        return check.refuse("emitters", fmt::format("has {} entries, must have at most {}", count, maxEmitters));
    if (scene.groups.size() + count > maxGroups)
        return check.refuse("emitters", fmt::format("are too many: groups and emitters are at most {}", maxGroups));
    const bool ratesKnown = check.isRight("step") && check.isRight("materials");
    check.entries("emitters", count, [&](std::size_t k, const std::string& field) {
        v1::Emitter one = message.emitters(static_cast<int>(k));
        if (seed) one.set_seed(*seed);
        const auto group = static_cast<std::uint16_t>(scene.groups.size());
        Emitter emitter = readEmitter(check, one, {.field = field, .stream = k, .group = group}, scene);
        scene.groups.push_back(groupFor(check, one, emitter, field));
        if (!check.ok() || !areBoundsKnown(check)) return;
        scene.emitters.push_back(std::move(emitter));
        if (ratesKnown) checkBirths(check, scene, field);
    });
}

void checkEmitterSpeeds(Check& check, const Scene& scene) {
    for (std::size_t k = 0; k < scene.emitters.size(); ++k) {
        const Emitter& emitter = scene.emitters[k];
        const double speed = glm::length(emitter.velocity) + emitter.velocitySpread;
        const double most = maxSpeed(scene, emitter.radii.min);
        if (speed > most)
            check.refuse(at("emitters", k),
                         fmt::format("makes spheres of radius {:g} m with up to {:g} m/s; the scene can compute {:g} "
                                     "m/s: make them slower or larger, or shorten the step",
                                     emitter.radii.min, speed, most),
                         Cause::Range, {.least = 0, .most = most});
    }
}

void writeEmitters(v1::Scene& message, const Scene& scene, double time, std::span<const EmitterProgress> progress) {
    for (std::size_t k = 0; k < scene.emitters.size(); ++k) {
        const Emitter& emitter = scene.emitters[k];
        if (progress[k].ended) continue;
        v1::Emitter& to = *message.add_emitters();
        to = *emitter.message;
        if (emitter.total) to.set_total(*emitter.total - progress[k].born);
        to.set_begin(emitter.begin - time);
    }
}

}  // namespace spherule::scene
