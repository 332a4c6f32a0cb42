#include "field_support.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace spherule::physics {

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

glm::dvec3 randomDirection(scene::Random& random) {
    return glm::normalize(glm::dvec3(random.normal(), random.normal(), random.normal()));
}

scene::Scene oneSphere(scene::Model model, glm::dvec3 place, glm::dvec3 velocity) {
    scene::Scene scene = fineStepSpace(20);
    scene.quality.model = model;
    scene::Sphere sphere;
    sphere.radius = static_cast<float>(fieldRadius);
    sphere.position = place;
    sphere.velocity = glm::vec3(velocity);
    scene.spheres.push_back(sphere);
    return scene;
}

glm::dvec3 placeOf(sim::Simulation& simulation, std::uint32_t id) {
    return positionOf(simulation.snapshot(), id) + simulation.scene().bounds.centre();
}

glm::dvec3 speedOf(sim::Simulation& simulation, std::uint32_t id) {
    return velocityOf(simulation.snapshot(), id);
}

glm::dvec3 windAt(const scene::Drag& drag, const glm::dvec3& x) {
    glm::dvec3 u = drag.velocity;
    if (!drag.vortex) return u;
    const glm::dvec3 axis = glm::normalize(drag.vortex->axis);
    const glm::dvec3 from = x - drag.vortex->centre;
    const glm::dvec3 out = from - axis * glm::dot(from, axis);
    const double r = glm::length(out);
    if (!(r > 0)) return u;
    const double share = r < drag.vortex->core ? r / drag.vortex->core : drag.vortex->core / r;
    return u + drag.vortex->speed * share * glm::cross(axis, out / r);
}

glm::dvec3 dragForce(const scene::Drag& drag, const glm::dvec3& x, const glm::dvec3& v) {
    const glm::dvec3 w = v - windAt(drag, x);
    return -0.5 * drag.density * drag.coefficient * pi * fieldRadius * fieldRadius * glm::length(w) * w;
}

glm::dvec3 buoyancyForce(const scene::Buoyancy& liquid, const glm::dvec3& gravity, const glm::dvec3& x) {
    double volume = fieldVolume;
    if (liquid.surface) {
        const double height = glm::dot(x - *liquid.surface, glm::normalize(-gravity));
        const double h = fieldRadius - height;  // of the cap
        if (h <= 0)
            volume = 0;
        else if (h < 2 * fieldRadius)
            volume = pi * h * h * (3 * fieldRadius - h) / 3;
    }
    return -liquid.density * volume * gravity;
}

glm::dvec3 accelerationOf(const scene::Forces& forces, const glm::dvec3& x, const glm::dvec3& v) {
    glm::dvec3 force = fieldMass * forces.gravity;
    for (const scene::Field& field : forces.fields) {
        if (const auto* const drag = std::get_if<scene::Drag>(&field)) force += dragForce(*drag, x, v);
        if (const auto* const liquid = std::get_if<scene::Buoyancy>(&field))
            force += buoyancyForce(*liquid, forces.gravity, x);
        if (const auto* const spring = std::get_if<scene::Spring>(&field))
            force -= spring->stiffness * (x - spring->centre) + spring->damping * v;
        if (const auto* const centre = std::get_if<scene::Attraction>(&field)) {
            const glm::dvec3 d = centre->centre - x;
            const double squared = glm::dot(d, d) + centre->softening * centre->softening;
            force += fieldMass * centre->strength / (squared * std::sqrt(squared)) * d;
        }
    }
    return force / fieldMass;
}

Motion integrated(const scene::Forces& forces, Motion from, double seconds) {
    constexpr double h = 5e-5;
    const auto slope = [&](const Motion& at) { return Motion{at.v, accelerationOf(forces, at.x, at.v)}; };
    const auto moved = [](const Motion& at, const Motion& by, double time) {
        return Motion{at.x + by.x * time, at.v + by.v * time};
    };
    for (long k = 0; k < std::lround(seconds / h); ++k) {
        const Motion a = slope(from);
        const Motion b = slope(moved(from, a, h / 2));
        const Motion c = slope(moved(from, b, h / 2));
        const Motion d = slope(moved(from, c, h));
        from.x += h / 6 * (a.x + 2.0 * b.x + 2.0 * c.x + d.x);
        from.v += h / 6 * (a.v + 2.0 * b.v + 2.0 * c.v + d.v);
    }
    return from;
}

double depthWithShare(double share) {
    double low = -fieldRadius;
    double high = fieldRadius;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        const double h = middle + fieldRadius;
        (pi * h * h * (3 * fieldRadius - h) / 3 < share * fieldVolume ? low : high) = middle;
    }
    return low;
}

double energyOf(sim::Simulation& simulation) {
    const sim::Statistics now = simulation.statistics();
    return now.kineticEnergy + now.potentialEnergy;
}

}  // namespace spherule::physics
