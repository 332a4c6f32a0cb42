#include "scene/stiffness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/materials.h"
#include "scene/shapes.h"

namespace spherule::scene {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double mostDamping = 15.8;  // parts with a thousandth of the speed; more would need shorter substeps
// Substeps per contact. More substeps reduce the error of the dashpots, which carry a share of the static force: 1.3 %
// at 50, below 1 % at this value.
constexpr double contactShare = 70;
constexpr double dampedEnough =
    2;  // stronger dashpots need shorter substeps, because the dashpots of all contacts add up
constexpr double rayleighShare = 10;

// Returns the restitution of a contact with this damping ratio: speed of parting over speed of approach.
double restitutionOf(double ratio) {
    if (ratio >= 1) {
        const double w = std::sqrt(ratio * ratio - 1);
        return w > 0 ? std::exp(-ratio / w * std::log((ratio + w) / (ratio - w))) : std::exp(-2.0);
    }
    const double w = std::sqrt(1 - ratio * ratio);
    const double angle = std::atan2(2 * ratio * w, 1 - 2 * ratio * ratio);
    return std::exp(-ratio / w * (pi - angle));
}

double shearModulus(const Material& material) {
    return material.young / (2 * (1 + material.poisson));
}

// Returns true if spheres meet fixed spheres, which are surfaces to them.
bool meetsFixed(const Scene& scene) {
    return scene.sphereContacts && std::ranges::any_of(scene.spheres, &Sphere::fixed);
}

std::set<std::uint8_t> materialsOfSpheres(const Scene& scene) {
    std::set<std::uint8_t> used;
    forEachSphere(scene, [&](const Sphere& sphere, double /*weight*/) {
        if (!sphere.fixed) used.insert(sphere.material);
    });
    return used;
}

std::set<std::uint8_t> materialsOfSurfaces(const Scene& scene) {
    std::set<std::uint8_t> used;
    if (hasWalls(scene)) used.insert(scene.bounds.material);
    for (const Obstacle& obstacle : scene.obstacles) used.insert(obstacle.material);
    if (meetsFixed(scene))
        for (const Sphere& sphere : scene.spheres)
            if (sphere.fixed) used.insert(sphere.material);
    return used;
}

// The extremes of the spheres that are not fixed.
struct Extremes {
    double smallest = std::numeric_limits<double>::infinity();  // radius, m
    double largest = 0;
    glm::dvec3 slowest{std::numeric_limits<double>::infinity()};  // of each component of the velocities, m/s
    glm::dvec3 fastest{-std::numeric_limits<double>::infinity()};
    double fall = 0;                                              // m
    double potential = -std::numeric_limits<double>::infinity();  // of the fields, where spheres begin, J/kg
    double blown = 0;                                             // speed that media give to them, m/s
    double volume = 0;                                            // m^3
    double densest = 0;                                           // kg/m^3
    double lightest = std::numeric_limits<double>::infinity();
};

// Returns the speed (m/s) that the media that move give to a sphere on its way through the bounds, or a higher one.
double speedInMedia(const Scene& scene, const Body& body) {
    double fastest = 0;
    double squared = 0;
    for (const Field& field : scene.forces.fields) {
        const auto* const drag = std::get_if<Drag>(&field);
        if (drag == nullptr) continue;
        const double speed = glm::length(drag->velocity) + (drag->vortex ? std::abs(drag->vortex->speed) : 0);
        const double force = 0.5 * drag->density * drag->coefficient * pi * body.radius * body.radius * speed * speed;
        fastest = std::max(fastest, speed);
        squared += 2 * force / body.mass * glm::distance(scene.bounds.min, scene.bounds.max);
    }
    return std::min(fastest, std::sqrt(squared));
}

Extremes extremesOf(const Scene& scene) {
    Extremes found;
    const double g = glm::length(scene.forces.gravity);
    const glm::dvec3 up = g > 0 ? -scene.forces.gravity / g : glm::dvec3(0);
    const glm::dvec3 half = 0.5 * (scene.bounds.max - scene.bounds.min);
    const double floor = -glm::dot(glm::abs(up), half);
    forEachSphere(scene, [&](const Sphere& sphere, double weight) {
        if (sphere.fixed) return;
        const auto r = static_cast<double>(sphere.radius);
        found.smallest = std::min(found.smallest, r);
        found.largest = std::max(found.largest, r);
        found.slowest = glm::min(found.slowest, glm::dvec3(sphere.velocity));
        found.fastest = glm::max(found.fastest, glm::dvec3(sphere.velocity));
        found.fall = std::max(found.fall, glm::dot(sphere.position - scene.bounds.centre(), up) - floor);
        if (!scene.forces.fields.empty()) {
            const Body body = bodyOf(scene, sphere);
            const double highest = scene.forces.highestFieldPotential(sphere.position, body, topOf(scene));
            found.potential = std::max(found.potential, highest);
            found.blown = std::max(found.blown, speedInMedia(scene, body));
        }
        found.volume += weight * 4.0 / 3 * pi * r * r * r;
        const double density = scene.materials[sphere.material].density;
        found.densest = std::max(found.densest, density);
        found.lightest = std::min(found.lightest, density);
    });
    return found;
}

bool hasSurfaces(const Scene& scene) {
    return hasWalls(scene) || !scene.obstacles.empty() || meetsFixed(scene);
}

// Returns true if a wall or an obstacle has friction with any sphere.
bool surfacesRub(const Scene& scene) {
    const std::set<std::uint8_t> used = materialsOfSpheres(scene);
    return std::ranges::any_of(materialsOfSurfaces(scene), [&](std::uint8_t b) {
        return std::ranges::any_of(used,
                                   [&](std::uint8_t a) { return contactParametersBetween(scene, a, b).friction > 0; });
    });
}

// Returns the part of `motion` that is parallel to all closed faces and planes. Returns 0 if there are other obstacles,
// obstacles that move, or fixed spheres.
// A common motion of this kind has no effect on contacts.
glm::dvec3 alongSurfaces(const Scene& scene, const glm::dvec3& motion) {
    if (meetsFixed(scene)) return glm::dvec3(0);
    std::vector<glm::dvec3> across;  // orthonormal
    const auto block = [&across](glm::dvec3 n) {
        for (const glm::dvec3& other : across) n -= other * glm::dot(n, other);
        if (const double length = glm::length(n); length > 1e-6) across.push_back(n / length);
    };
    for (unsigned face = 0; face < 6; ++face) {
        glm::dvec3 n(0);
        n[static_cast<int>(face / 2)] = 1;
        if (scene.bounds.walled(face)) block(n);
    }
    for (const Obstacle& obstacle : scene.obstacles) {
        const std::optional<glm::dvec3> normal = obstacle.shape->normalOfHalfSpace();
        if (!normal || obstacle.motion) return glm::dvec3(0);
        block(*normal);
    }
    glm::dvec3 left = motion;
    for (const glm::dvec3& n : across) left -= n * glm::dot(left, n);
    return left;
}

// Returns the square of the speed (m^2/s^2) that a sphere gains by falling in the fields.
double fieldDrop(const Scene& scene, const Extremes& extremes) {
    if (scene.forces.fields.empty() || !(extremes.largest > 0)) return 0;
    const Bounds& bounds = scene.bounds;
    const bool closed = std::ranges::find(bounds.open, true) == bounds.open.end();
    const auto nearestTo = [&](const glm::dvec3& centre) {
        const double outside = closed ? glm::distance(centre, glm::clamp(centre, bounds.min, bounds.max)) : 0;
        return std::max(outside, extremes.smallest);
    };
    return 2 * std::max(extremes.potential - scene.forces.lowestFieldPotential(nearestTo), 0.0);
}

struct Meetings {
    double spheres = 0;   // m/s: two spheres head-on
    double surfaces = 0;  // m/s: a sphere relative to bodies at rest
};

// Returns the fastest meetings. Speeds are relative to the common motion of all spheres, as far as the surfaces of the
// scene allow such a motion. With surfaces, spheres that bounce back may meet at twice the fastest speed. Without
// surfaces, gravity and a common motion do not count. The speed is then twice the largest difference of two velocities,
// because a light sphere leaves a heavy one twice as fast as they met. Spheres fall to a centre of attraction from all
// sides, as near as the smallest radius.
Meetings meetingsOf(const Scene& scene, const Extremes& extremes) {
    constexpr double grain = 1.0 / 30;
    Meetings fastest;
    if (!(extremes.largest > 0)) return fastest;
    const bool stopped = hasSurfaces(scene);
    glm::dvec3 common(0);
    if (!stopped || !surfacesRub(scene)) common = alongSurfaces(scene, 0.5 * (extremes.slowest + extremes.fastest));
    double speed = 0;
    forEachSphere(scene, [&](const Sphere& sphere, double /*weight*/) {
        speed = std::max(speed, glm::length(glm::dvec3(sphere.velocity) - common));
    });
    // An obstacle throws a sphere at up to twice its own speed, and its belt carries one along.
    double thrown = 0;
    for (const Obstacle& obstacle : scene.obstacles)
        if (obstacle.motion)
            thrown = std::max(thrown, 2 * obstacle.largestSpeed(scene.bounds) + glm::length(obstacle.motion->belt));
    speed += thrown + extremes.blown;
    const double fall = stopped ? 2 * glm::length(scene.forces.gravity) * extremes.fall : 0;
    const double drop = fieldDrop(scene, extremes);
    if (scene.sphereContacts && mayHaveTwo(scene))
        fastest.spheres = std::sqrt((stopped ? 4 : 16) * speed * speed + fall + 4 * drop);
    if (stopped) fastest.surfaces = std::sqrt(speed * speed + fall + drop);
    // If nothing moves or falls, a slow speed is derived from the step.
    if (!(std::max(fastest.spheres, fastest.surfaces) > 0)) fastest.spheres = grain * extremes.smallest / scene.step;
    return fastest;
}

double fastestImpact(const Scene& scene, const Extremes& extremes) {
    const Meetings fastest = meetingsOf(scene, extremes);
    return std::max(fastest.spheres, fastest.surfaces);
}

constexpr double solid = 0.6;  // share of a pile's volume

// Returns the pressure (Pa) of all spheres and of bodies that press them, spread over the ground; 0 if there is no
// ground.
double pressureOfPile(const Scene& scene, const Extremes& extremes) {
    const double g = glm::length(scene.forces.gravity);
    if (!(g > 0) || !hasSurfaces(scene)) return 0;
    const glm::dvec3 extent = scene.bounds.max - scene.bounds.min;
    const glm::dvec3 down = glm::abs(scene.forces.gravity) / g;
    const double across = extent.x * extent.y * extent.z / glm::dot(extent, down);
    const double height = std::min(extremes.volume / solid / across, glm::dot(extent, down));
    double pressed = 0;  // N, by bodies that slide
    for (const Obstacle& obstacle : scene.obstacles)
        if (obstacle.motion && obstacle.motion->drive && !obstacle.motion->drive->turns)
            pressed += std::abs(obstacle.motion->drive->forceAt(scene.forces.gravity, obstacle.motion->pivot));
    return solid * extremes.densest * g * height + pressed / across;
}

// Returns the modulus (Pa) for the scene's wanted overlap, for two equal spheres or for a sphere and a wall.
double modulusForOverlap(const Scene& scene) {
    constexpr double atRest = 0.2;
    const Extremes extremes = extremesOf(scene);
    const double overlap = scene.quality.overlap;
    const double v = fastestImpact(scene, extremes);
    const double impact = 2.0 / 3 * pi * extremes.densest * v * v / (overlap * overlap);
    return std::max(impact, 4 * pressureOfPile(scene, extremes) / (atRest * overlap));
}

double substepsPerContact(const Scene& scene) {
    double strongest = dampedEnough;
    for (const ContactParameters& contact : actingContactParameters(scene))
        strongest = std::max(strongest, dampingRatio(contact.restitution));
    return contactShare * strongest / dampedEnough;
}

// Returns the modulus (Pa) that the substeps allow, for the smallest radius and the lowest density. The spring constant
// is half a sphere's mass times the square of the contact's angular frequency. The modulus is the spring constant over
// the radius.
double modulusForSubstep(const Scene& scene) {
    const Extremes extremes = extremesOf(scene);
    const double contact = substepsPerContact(scene) * scene.step / scene.quality.substeps;
    const double r = std::isfinite(extremes.smallest) ? extremes.smallest : 1;
    return 2.0 / 3 * pi * r * r *
           (std::isfinite(extremes.lightest) ? extremes.lightest : scene.materials.front().density) *
           std::pow(pi / contact, 2);
}

// Tangential over normal stiffness of linear springs. With this ratio the tangential frequency equals the normal one.
constexpr double tangentialShare = 2.0 / 7;

double compliance(const Material& material) {
    return (1 - material.poisson * material.poisson) / material.young;
}

// Returns the effective modulus (Pa) at which the overlap is `share` of the radius, for a sphere of this density
// against an equal one or a wall. It holds for an impact at `speed`, and at rest under `pressure` or the sphere's own
// weight.
double modulusThatBears(double share, double density, double speed, double pressure, double ownWeight, bool wall) {
    const double impact =
        15.0 / 16 * 4.0 / 3 * pi * density * speed * speed / (wall ? 1 : std::sqrt(2)) / std::pow(share, 2.5);
    const double force = std::max(4 * pressure, ownWeight);  // over r^2
    return std::max(impact, 0.75 * force * (wall ? 1 : std::sqrt(2)) / std::pow(share, 1.5));
}

}  // namespace

bool followsHertz(const Scene& scene) {
    return std::ranges::any_of(scene.materials, [](const Material& material) { return material.young > 0; });
}

double dampingRatio(double restitution) {
    if (restitution >= 1) return 0;
    double low = 0;
    double high = mostDamping;
    if (restitution <= restitutionOf(high)) return high;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (restitutionOf(middle) > restitution ? low : high) = middle;
    }
    return low;
}

double springModulus(const Scene& scene) {
    if (followsHertz(scene)) return 0;
    return scene.quality.substepsFixed ? modulusForSubstep(scene) : modulusForOverlap(scene);
}

Stiffness stiffnessBetween(const Scene& scene, std::uint8_t a, std::uint8_t b, double springModulus) {
    Stiffness stiffness;
    stiffness.damping = dampingRatio(contactParametersBetween(scene, a, b).restitution);
    if (springModulus > 0) {
        stiffness.normal = springModulus;
        stiffness.tangential = tangentialShare * stiffness.normal;
        return stiffness;
    }
    const auto shear = [](const Material& m) { return (2 - m.poisson) / shearModulus(m); };
    const Material& first = scene.materials[a];
    const Material& second = scene.materials[b];
    stiffness.normal = 1 / (compliance(first) + compliance(second));
    stiffness.tangential = 1 / (shear(first) + shear(second));
    return stiffness;
}

std::optional<TooSoft> tooSoft(const Scene& scene) {
    constexpr double deepest = 0.5;
    const Extremes extremes = extremesOf(scene);
    const Meetings fastest = meetingsOf(scene, extremes);
    const double pressure = pressureOfPile(scene, extremes);
    const double g = hasSurfaces(scene) ? glm::length(scene.forces.gravity) : 0;
    std::optional<TooSoft> worst;
    const auto look = [&](std::uint8_t a, std::uint8_t b, bool wall) {
        const double density = scene.materials[a].density;
        const double weight = 4.0 / 3 * pi * density * g * extremes.largest;
        const double needed =
            modulusThatBears(deepest, density, wall ? fastest.surfaces : fastest.spheres, pressure, weight, wall);
        const double modulus = 1 / (compliance(scene.materials[a]) + compliance(scene.materials[b]));
        if (!(needed > modulus) || (worst && worst->share >= needed / modulus)) return;
        const std::uint8_t softer = scene.materials[a].young <= scene.materials[b].young ? a : b;
        const Material& material = scene.materials[softer];
        // The modulus of the other material stays the same, if that is enough.
        const double left = 1 / needed - (a == b ? 0 : compliance(scene.materials[softer == a ? b : a]));
        double young = material.young * needed / modulus;
        if (a != b && left > 0) young = (1 - material.poisson * material.poisson) / left;
        worst = TooSoft{.material = softer, .smallestYoung = young, .share = needed / modulus};
    };
    for (const std::uint8_t a : materialsOfSpheres(scene)) {
        for (const std::uint8_t b : materialsOfSurfaces(scene)) look(a, b, true);
        if (!scene.sphereContacts || !mayHaveTwo(scene)) continue;
        for (const std::uint8_t b : materialsOfSpheres(scene)) look(a, b, false);
    }
    return worst;
}

ContactTime contactTimeOf(const Scene& scene) {
    const Extremes extremes = extremesOf(scene);
    const double modulus = springModulus(scene);
    ContactTime time;
    time.speed = fastestImpact(scene, extremes);
    time.contact = std::numeric_limits<double>::infinity();
    time.substep = scene.step;
    const std::set<std::uint8_t> used = materialsOfSpheres(scene);
    std::set<std::uint8_t> met = used;
    met.merge(materialsOfSurfaces(scene));
    for (const std::uint8_t a : used) {
        const Material& material = scene.materials[a];
        const double r = extremes.smallest;
        const double mass = 4.0 / 3 * pi * r * r * r * material.density / 2;
        for (const std::uint8_t b : met) {
            const Stiffness stiffness = stiffnessBetween(scene, a, b, modulus);
            const double contact =
                followsHertz(scene)
                    ? 2.87 * std::pow(mass * mass / (r / 2 * stiffness.normal * stiffness.normal * time.speed), 0.2)
                    : pi * std::sqrt(mass / (stiffness.normal * r));
            time.contact = std::min(time.contact, contact);
        }
        if (!followsHertz(scene)) continue;
        // Thornton and Randall 1988.
        const double rayleigh =
            pi * r * std::sqrt(material.density / shearModulus(material)) / (0.163 * material.poisson + 0.8766);
        time.substep = std::min(time.substep, rayleigh / rayleighShare);
    }
    time.substep = std::min(time.substep, time.contact / substepsPerContact(scene));
    if (extremes.largest > 0) time.overlap = time.speed * time.contact / pi / extremes.smallest;
    return time;
}

}  // namespace spherule::scene
