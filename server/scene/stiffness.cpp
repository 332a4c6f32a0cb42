#include "scene/stiffness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>

#include "scene/materials.h"

namespace spherule::scene {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double mostDamping = 15.8;  // parts with a thousandth of the speed; more would need shorter substeps
constexpr double slowest = 0.1;       // m/s: impacts that are to be expected in any case
// Substeps in a contact. The dashpots' error, which bears a share of the static force, falls with it: 1.3 % at 50,
// below a hundredth here.
constexpr double contactShare = 70;
constexpr double dampedEnough = 2;  // stronger dashpots ask for shorter substeps: those of all contacts add up
constexpr double rayleighShare = 10;

// Speed over approach speed after a contact with this damping ratio.
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

struct Extremes {
    double smallest = std::numeric_limits<double>::infinity();  // radius, m
    double largest = 0;
    double speed = 0;    // m/s
    double fall = 0;     // m
    double volume = 0;   // m^3
    double densest = 0;  // kg/m^3
    double lightest = std::numeric_limits<double>::infinity();
};

Extremes extremesOf(const Scene& scene) {
    Extremes found;
    const double g = glm::length(scene.gravity);
    const glm::dvec3 up = g > 0 ? -scene.gravity / g : glm::dvec3(0);
    const glm::dvec3 half = 0.5 * (scene.bounds.max - scene.bounds.min);
    const double floor = -glm::dot(glm::abs(up), half);
    for (const Sphere& sphere : scene.spheres) {
        const auto r = static_cast<double>(sphere.radius);
        found.smallest = std::min(found.smallest, r);
        found.largest = std::max(found.largest, r);
        found.speed = std::max(found.speed, static_cast<double>(glm::length(sphere.velocity)));
        found.fall = std::max(found.fall, glm::dot(sphere.position - scene.bounds.centre(), up) - floor);
        found.volume += 4.0 / 3 * pi * r * r * r;
        const double density = scene.materials[sphere.material].density;
        found.densest = std::max(found.densest, density);
        found.lightest = std::min(found.lightest, density);
    }
    return found;
}

double fastestImpact(const Scene& scene, const Extremes& extremes) {
    const double g = glm::length(scene.gravity);
    const double meeting = (scene.sphereContacts && scene.spheres.size() > 1 ? 2 : 1) * extremes.speed;
    return std::max(slowest, std::sqrt(meeting * meeting + 2 * g * extremes.fall));
}

// The impact of two equal spheres, or of one on a wall.
double modulusForOverlap(const Scene& scene) {
    constexpr double atRest = 0.2;
    constexpr double solid = 0.6;  // of a pile
    const Extremes extremes = extremesOf(scene);
    const double overlap = scene.quality.overlap;
    const double v = fastestImpact(scene, extremes);
    const double impact = 2.0 / 3 * pi * extremes.densest * v * v / (overlap * overlap);
    const glm::dvec3 extent = scene.bounds.max - scene.bounds.min;
    const double g = glm::length(scene.gravity);
    const glm::dvec3 down = g > 0 ? glm::abs(scene.gravity) / g : glm::dvec3(0, 0, 1);
    const double across = extent.x * extent.y * extent.z / glm::dot(extent, down);
    const double height = std::min(extremes.volume / solid / across, glm::dot(extent, down));
    const double weight = 4 * solid * extremes.densest * g * height / (atRest * overlap);
    return std::max(impact, weight);
}

double substepsPerContact(const Scene& scene) {
    double strongest = dampedEnough;
    for (const PairLaw& law : actingLaws(scene)) strongest = std::max(strongest, dampingRatio(law.restitution));
    return contactShare * strongest / dampedEnough;
}

// Of equal spheres of this radius and density: half their mass over the square of the contact's frequency.
double modulusForSubstep(const Scene& scene) {
    const Extremes extremes = extremesOf(scene);
    const double contact = substepsPerContact(scene) * scene.step / scene.quality.substeps;
    const double r = std::isfinite(extremes.smallest) ? extremes.smallest : 1;
    return 2.0 / 3 * pi * r * r *
           (std::isfinite(extremes.lightest) ? extremes.lightest : scene.materials.front().density) *
           std::pow(pi / contact, 2);
}

// Tangential stiffness of linear springs, of the normal one: the tangential frequency is then the normal one.
constexpr double tangentialShare = 2.0 / 7;

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
    return scene.quality.pinned ? modulusForSubstep(scene) : modulusForOverlap(scene);
}

Stiffness stiffnessBetween(const Scene& scene, std::uint8_t a, std::uint8_t b, double springModulus) {
    Stiffness law;
    law.damping = dampingRatio(lawBetween(scene, a, b).restitution);
    if (springModulus > 0) {
        law.normal = springModulus;
        law.tangential = tangentialShare * law.normal;
        return law;
    }
    const auto compliance = [](const Material& m) { return (1 - m.poisson * m.poisson) / m.young; };
    const auto shear = [](const Material& m) { return (2 - m.poisson) / shearModulus(m); };
    const Material& first = scene.materials[a];
    const Material& second = scene.materials[b];
    law.normal = 1 / (compliance(first) + compliance(second));
    law.tangential = 1 / (shear(first) + shear(second));
    return law;
}

ContactTime contactTimeOf(const Scene& scene) {
    const Extremes extremes = extremesOf(scene);
    const double modulus = springModulus(scene);
    ContactTime time;
    time.speed = fastestImpact(scene, extremes);
    time.contact = std::numeric_limits<double>::infinity();
    time.substep = scene.step;
    std::set<std::uint8_t> used;
    for (const Sphere& sphere : scene.spheres) used.insert(sphere.material);
    std::set<std::uint8_t> met = used;
    met.insert(scene.bounds.material);
    for (const Obstacle& obstacle : scene.obstacles) met.insert(obstacle.material);
    for (const std::uint8_t a : used) {
        const Material& material = scene.materials[a];
        const double r = extremes.smallest;
        const double mass = 4.0 / 3 * pi * r * r * r * material.density / 2;
        for (const std::uint8_t b : met) {
            const Stiffness law = stiffnessBetween(scene, a, b, modulus);
            const double contact =
                followsHertz(scene) ? 2.87 * std::pow(mass * mass / (r / 2 * law.normal * law.normal * time.speed), 0.2)
                                    : pi * std::sqrt(mass / (law.normal * r));
            time.contact = std::min(time.contact, contact);
        }
        if (!followsHertz(scene)) continue;
        // Thornton and Randall 1988.
        const double rayleigh =
            pi * r * std::sqrt(material.density / shearModulus(material)) / (0.163 * material.poisson + 0.8766);
        time.substep = std::min(time.substep, rayleigh / rayleighShare);
    }
    time.substep = std::min(time.substep, time.contact / substepsPerContact(scene));
    if (!scene.spheres.empty()) time.overlap = time.speed * time.contact / pi / extremes.smallest;
    return time;
}

}  // namespace spherule::scene
