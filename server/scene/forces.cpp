#include "scene/forces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <spdlog/fmt/fmt.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/scene.h"

namespace spherule::scene {

namespace {

constexpr double pi = std::numbers::pi;

bool acts(const Field& field, const glm::dvec3& place) {
    const std::optional<Region>& region = regionOf(field);
    return !region || contains(*region, place);
}

// Returns how deep (m) a place is in the liquid below `surface`; 0 without gravity.
double depthOf(const glm::dvec3& place, const glm::dvec3& surface, const glm::dvec3& gravity) {
    const double g = glm::length(gravity);
    return g > 0 ? glm::dot(place - surface, gravity) / g : 0;
}

// The acceleration (m/s^2) of a sphere at rest by a field in whose region it is. Drag acts on moving spheres.
struct AccelerationBy {
    const glm::dvec3& place;
    const glm::dvec3& gravity;
    const Body& body;

    glm::dvec3 operator()(const Drag& /*drag*/) const { return {}; }
    glm::dvec3 operator()(const Attraction& attraction) const {
        const glm::dvec3 d = attraction.centre - place;
        return d * (attraction.strength / std::pow(std::hypot(glm::length(d), attraction.softening), 3));
    }
    glm::dvec3 operator()(const Buoyancy& liquid) const {
        const double depth = liquid.surface ? depthOf(place, *liquid.surface, gravity) : body.radius;
        return gravity * (-liquid.density * submergedVolume(body.radius, depth) / body.mass);
    }
    glm::dvec3 operator()(const Spring& spring) const {
        return (spring.centre - place) * (spring.stiffness / body.mass);
    }
};

// The potential (J/kg) of a field.
struct PotentialOf {
    const glm::dvec3& place;
    const glm::dvec3& gravity;
    const Body& body;
    const glm::dvec3& top;

    double operator()(const Drag& /*drag*/) const { return 0; }
    double operator()(const Attraction& attraction) const {
        return potentialOf(attraction, glm::distance(attraction.centre, place));
    }
    double operator()(const Buoyancy& liquid) const {
        const double depth = depthOf(place, liquid.surface.value_or(top), gravity);
        const double integral =
            liquid.surface ? submergedIntegral(body.radius, depth) : submergedVolume(body.radius, body.radius) * depth;
        return liquid.density * glm::length(gravity) * integral / body.mass;
    }
    double operator()(const Spring& spring) const {
        const glm::dvec3 d = spring.centre - place;
        return 0.5 * spring.stiffness * glm::dot(d, d) / body.mass;
    }
};

// The highest potential (J/kg) of a field at the places of a ball, or a higher value.
struct HighestPotentialIn {
    const BallRegion& ball;
    const glm::dvec3& gravity;
    const Body& body;
    const glm::dvec3& top;

    double operator()(const Drag& /*drag*/) const { return 0; }
    double operator()(const Attraction& attraction) const { return std::max(potentialOf(attraction, 0), 0.0); }
    double operator()(const Buoyancy& liquid) const {
        const double g = glm::length(gravity);
        const glm::dvec3 deepest = g > 0 ? ball.centre + gravity * (ball.radius / g) : ball.centre;
        return PotentialOf{deepest, gravity, body, top}(liquid);
    }
    double operator()(const Spring& spring) const {
        const double farthest = glm::distance(spring.centre, ball.centre) + ball.radius;
        return 0.5 * spring.stiffness * farthest * farthest / body.mass;
    }
};

}  // namespace

glm::dvec3 Forces::accelerationAt(const glm::dvec3& place, const Body& body) const {
    glm::dvec3 sum = gravity;
    for (const Field& field : fields)
        if (acts(field, place)) sum += std::visit(AccelerationBy{place, gravity, body}, field);
    return sum;
}

glm::dvec3 Forces::dragAt(const glm::dvec3& place, const glm::dvec3& velocity, const Body& body) const {
    glm::dvec3 sum(0);
    for (const Field& field : fields) {
        const auto* const drag = std::get_if<Drag>(&field);
        if (drag == nullptr || !acts(field, place)) continue;
        const glm::dvec3 wind = drag->velocityAt(place) - velocity;
        sum += wind * (glm::length(wind) * 0.5 * drag->density * drag->coefficient * pi * body.radius * body.radius /
                       body.mass);
    }
    return sum;
}

double Forces::highestFieldPotential(const glm::dvec3& place, const Body& body, const glm::dvec3& top) const {
    double sum = 0;
    for (const Field& field : fields) {
        const std::optional<Region>& region = regionOf(field);
        sum += region ? std::visit(HighestPotentialIn{ballAround(*region), gravity, body, top}, field)
                      : std::visit(PotentialOf{place, gravity, body, top}, field);
    }
    return sum;
}

// The restoring force of a liquid per displacement is density gravity times the section of the sphere with the surface,
// at most pi r^2.
double Forces::frequencyOf(const Body& body) const {
    double stiffness = 0;  // N/m
    for (const Field& field : fields) {
        if (const auto* const spring = std::get_if<Spring>(&field)) stiffness += spring->stiffness;
        if (const auto* const liquid = std::get_if<Buoyancy>(&field); liquid != nullptr && liquid->surface)
            stiffness += liquid->density * glm::length(gravity) * pi * body.radius * body.radius;
    }
    return std::sqrt(stiffness / body.mass);
}

bool Forces::addEnergy() const {
    return std::ranges::any_of(fields, addsEnergy);
}

double potentialOf(const Attraction& attraction, double distance) {
    return -attraction.strength / std::hypot(distance, attraction.softening);
}

Body bodyOf(const Scene& scene, const Sphere& sphere) {
    const auto r = static_cast<double>(sphere.radius);
    return {.radius = r, .mass = 4.0 / 3 * pi * r * r * r * scene.materials[sphere.material].density};
}

glm::dvec3 topOf(const Scene& scene) {
    const glm::dvec3 half = 0.5 * (scene.bounds.max - scene.bounds.min);
    return scene.bounds.centre() - glm::sign(scene.forces.gravity) * half;
}

double strongestAcceleration(const Scene& scene) {
    constexpr std::size_t mostPlaces = 10'000;  // about a millisecond
    const Forces& forces = scene.forces;
    double strongest = glm::length(forces.gravity);
    double shaken = 0;  // spheres that obstacles carry
    for (const Obstacle& obstacle : scene.obstacles)
        if (obstacle.motion) shaken = std::max(shaken, obstacle.motion->speeds().acceleration);
    strongest += shaken;
    const auto pushes = [](const Field& field) {
        const auto* const drag = std::get_if<Drag>(&field);
        return drag == nullptr || drag->moves();
    };
    if (std::ranges::none_of(forces.fields, pushes)) return strongest;
    const std::size_t stride = scene.spheres.size() / mostPlaces + 1;
    const auto look = [&](const Sphere& sphere) {
        if (sphere.fixed) return;
        const Body body = bodyOf(scene, sphere);
        const glm::dvec3 pull =
            forces.accelerationAt(sphere.position, body) + forces.dragAt(sphere.position, glm::dvec3(0), body);
        strongest = std::max(strongest, glm::length(pull));
    };
    for (std::size_t id = 0; id < scene.spheres.size(); id += stride) look(scene.spheres[id]);
    for (const Emitter& emitter : scene.emitters) std::ranges::for_each(emitter.samples, look);
    return strongest;
}

double highestFieldFrequency(const Scene& scene) {
    if (!(scene.forces.frequencyOf({.radius = 1, .mass = 1}) > 0)) return 0;
    double highest = 0;
    forEachSphere(scene, [&](const Sphere& sphere, double /*weight*/) {
        if (!sphere.fixed) highest = std::max(highest, scene.forces.frequencyOf(bodyOf(scene, sphere)));
    });
    return highest;
}

Result<void> checkLiquids(const Scene& scene) {
    constexpr const char* axisNames[] = {"X", "Y", "Z"};
    for (std::size_t k = 0; k < scene.forces.fields.size(); ++k) {
        if (!std::holds_alternative<Buoyancy>(scene.forces.fields[k])) continue;
        const std::string field = fmt::format("fields[{}].buoyancy", k);
        if (!(glm::length(scene.forces.gravity) > 0))
            return fail(ErrorKind::Input, field,
                        "needs gravity, which is zero; give the scene a gravity or remove the buoyancy");
        for (int axis = 0; axis < 3; ++axis)
            if (scene.bounds.periodic[static_cast<std::size_t>(axis)] && scene.forces.gravity[axis] != 0)
                return fail(ErrorKind::Input, field,
                            fmt::format("is of a liquid at rest, but gravity has a part along the periodic axis {}, "
                                        "along which the liquid would flow; remove one of them",
                                        axisNames[axis]));
    }
    return {};
}

}  // namespace spherule::scene
