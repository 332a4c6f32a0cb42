#include "soft_reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace spherule::reference {

namespace {

struct Pair {
    double radius = 0;  // effective, m
    double mass = 0;    // effective, kg
};

struct Forces {
    double normal = 0;     // N, of the spring
    double damping = 0;    // N s/m
    double stiffness = 0;  // N/m, tangential
    double drag = 0;       // N s/m, tangential
};

Forces forcesAt(const SoftLaw& law, const Pair& pair, double overlap) {
    const double strongest = std::min(law.damping, 0.3);
    Forces f;
    if (law.hertz) {
        const double disc = std::sqrt(pair.radius * overlap);
        f.normal = 4.0 / 3 * law.normal * disc * overlap;
        f.damping = 2 * law.damping * std::sqrt(5.0 / 6 * 2 * law.normal * disc * pair.mass);
        f.stiffness = 8 * law.tangential * disc;
        f.drag = 2 * strongest * std::sqrt(5.0 / 6 * f.stiffness * pair.mass);
    } else {
        const double stiffness = 2 * law.normal * pair.radius;
        f.normal = stiffness * overlap;
        f.damping = 2 * law.damping * std::sqrt(stiffness * pair.mass);
        f.stiffness = 2 * law.tangential * pair.radius;
        f.drag = 2 * strongest * std::sqrt(f.stiffness * pair.mass);
    }
    return f;
}

double contactTime(const SoftLaw& law, const Pair& pair, double speed) {
    if (!law.hertz) return std::numbers::pi * std::sqrt(pair.mass / (2 * law.normal * pair.radius));
    const double deepest =
        std::pow(15 * pair.mass * speed * speed / (16 * law.normal * std::sqrt(pair.radius)), 2.0 / 5);
    return 2.943 * deepest / speed;
}

// Integrates the force of the tangential spring on the first body. Returns the tangential force: spring and dashpot,
// limited by friction. `slip` is the velocity of the first surface relative to the second (m/s).
class Tangent {
  public:
    glm::dvec3 force(const SoftLaw& law, const Forces& f, double normal, glm::dvec3 n, glm::dvec3 slip, double h) {
        const double length = glm::length(spring_);
        spring_ -= n * glm::dot(spring_, n);
        if (const double left = glm::length(spring_); left > 0) spring_ *= length / left;
        // A contact that opens releases a part of the spring's force; one that closes does not change it.
        if (f.stiffness < stiffness_) spring_ *= f.stiffness / stiffness_;
        stiffness_ = f.stiffness;
        spring_ -= slip * (f.stiffness * h);
        const glm::dvec3 both = spring_ - slip * f.drag;
        const double most = law.friction * normal;
        const double size = glm::length(both);
        if (size <= most) return both;
        const glm::dvec3 held = both * (most / size);
        spring_ = held + slip * f.drag;
        return held;
    }

  private:
    glm::dvec3 spring_{};
    double stiffness_ = 0;
};

void turn(SoftBody& body, double arm, glm::dvec3 n, glm::dvec3 impulse) {
    body.spin -= glm::cross(n, impulse) * (arm * 2.5 * body.inverseMass / (body.radius * body.radius));
}

}  // namespace

double SoftBody::rotationalEnergy() const {
    return 0.2 / inverseMass * radius * radius * glm::dot(spin, spin);
}

void meet(SoftBody& a, SoftBody& b, const SoftLaw& law, int steps) {
    const Pair pair{a.radius * b.radius / (a.radius + b.radius), 1 / (a.inverseMass + b.inverseMass)};
    const double reach = a.radius + b.radius;
    // Move the bodies to the first contact.
    const glm::dvec3 d = a.x - b.x;
    const glm::dvec3 w = a.v - b.v;
    const double along = glm::dot(d, w);
    const double until =
        (-along - std::sqrt(along * along - glm::dot(w, w) * (glm::dot(d, d) - reach * reach))) / glm::dot(w, w);
    a.x += a.v * until;
    b.x += b.v * until;
    const double h = contactTime(law, pair, -glm::dot(w, glm::normalize(a.x - b.x))) / steps;
    Tangent tangent;
    for (int k = 0; k < 10 * steps; ++k) {
        a.x += a.v * h;
        b.x += b.v * h;
        const double distance = glm::length(a.x - b.x);
        if (distance >= reach) return;
        const glm::dvec3 n = (a.x - b.x) / distance;
        const double armA = a.radius * distance / reach;
        const double armB = b.radius * distance / reach;
        const glm::dvec3 relative = a.v - b.v;
        const double speed = glm::dot(relative, n);
        const glm::dvec3 slip = relative - n * speed - glm::cross(a.spin * armA + b.spin * armB, n);
        const Forces f = forcesAt(law, pair, reach - distance);
        const double normal = std::max(f.normal - f.damping * speed, 0.0);
        const glm::dvec3 rub = tangent.force(law, f, normal, n, slip, h) * h;
        const glm::dvec3 impulse = n * (normal * h) + rub;
        a.v += impulse * a.inverseMass;
        b.v -= impulse * b.inverseMass;
        turn(a, armA, n, rub);
        turn(b, armB, n, rub);
    }
}

void meetFloor(SoftBody& body, const SoftLaw& law, int steps) {
    const Pair pair{body.radius, 1 / body.inverseMass};
    const glm::dvec3 n(0, 0, 1);
    body.x += body.v * ((body.x.z - body.radius) / -body.v.z);
    const double h = contactTime(law, pair, -body.v.z) / steps;
    Tangent tangent;
    for (int k = 0; k < 10 * steps; ++k) {
        body.x += body.v * h;
        if (body.x.z >= body.radius) return;
        const glm::dvec3 slip = body.v - n * body.v.z - glm::cross(body.spin * body.x.z, n);
        const Forces f = forcesAt(law, pair, body.radius - body.x.z);
        const double normal = std::max(f.normal - f.damping * body.v.z, 0.0);
        const glm::dvec3 rub = tangent.force(law, f, normal, n, slip, h) * h;
        body.v += (n * (normal * h) + rub) * body.inverseMass;
        turn(body, body.x.z, n, rub);
    }
}

}  // namespace spherule::reference
