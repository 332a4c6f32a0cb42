#include "reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace spherule::reference {

namespace {

constexpr double meanOver = 8;           // substeps of the mean acceleration
constexpr double impactLimit = 2;        // an impact is faster than this, over the change by acceleration
constexpr double loadLimit = 5;          // and faster than this, over the change by the held impulse
constexpr double loadsKept = 1;          // largest impulse that an impact leaves, over the load that both bodies carry
constexpr double overlapRemoved = 0.3;   // share that a pair removes in a substep
constexpr double slop = 0.001;           // overlap that stays, in radii
constexpr double softFriction = 0.05;    // a contact with less friction,
constexpr double softRestitution = 0.9;  // and with less restitution, is soft
constexpr double softGap = 1e-5;         // up to this gap, in radii
constexpr double softest = 0.125;        // largest overlap that a soft contact removes in a substep, in radii
constexpr double leastLoad = 1e-5;       // share of an impact below which a load is rounding

// A damped spring of 0.2 periods per substep, as an implicit Euler step integrates it.
constexpr double angle = 2 * std::numbers::pi * 0.2;                         // per substep
constexpr double damping = 2;                                                // ratio
constexpr double springRemoves = angle / (2 * damping + angle);              // share of the overlap
constexpr double springShare = 1 - 1 / (1 + angle * (2 * damping + angle));  // of the rigid impulse

// An impulse changes the velocity of a solid sphere's surface 7/2 times as much as the velocity of its centre.
constexpr double surface = 3.5;

// The change of the spin by a torque per lever (1/kg/m).
double spinOf(const Sphere& sphere) {
    return 2.5 * sphere.inverseMass / sphere.radius;
}

glm::dvec3 tangentialOf(const glm::dvec3& vector, const glm::dvec3& n) {
    return vector - n * glm::dot(vector, n);
}

// The first time at which two points at a distance `d` with the velocity `path` are at `reach`; negative: never.
double meetingTime(const glm::dvec3& d, const glm::dvec3& path, double reach) {
    const double a = glm::dot(path, path);
    const double b = glm::dot(d, path);
    const double discriminant = b * b - a * (glm::dot(d, d) - reach * reach);
    return discriminant > 0 ? (-b - std::sqrt(discriminant)) / a : -1;
}

bool holdsAny(const Held& held) {
    return held.impulse != glm::dvec3(0);
}

}  // namespace

// A contact while it is solved. Speeds are along the normal; negative: approaching.
struct World::Contact {
    glm::dvec3 n{};         // towards the first body
    glm::dvec3 d{};         // between the centres
    double reach = 0;       // sum of the radii
    double separation = 0;  // m
    double mass = 0;        // reduced
    double radius = 0;      // the smaller one
    double restitution = 0;
    double friction = 0;
    Held held{};        // before
    double speed = 0;   // m/s
    double target = 0;  // m/s, to be reached
    double lever = 1;   // of friction, over the radius
    bool impact = false;
    double time = 0;  // s, of an impact in the substep
    double load = 0;  // N s, that both bodies carry at an impact

    [[nodiscard]] double heldAlong() const { return glm::dot(held.impulse, n); }
    // Approaches slower than this are no impacts (m/s). `change`: by acceleration in a substep.
    [[nodiscard]] double limit(double change) const {
        return std::max(impactLimit * change, loadLimit * heldAlong() / mass);
    }
    [[nodiscard]] bool soft() const {
        return friction < softFriction && restitution < softRestitution && separation <= softGap * radius && !impact;
    }
    [[nodiscard]] double push(double share) const {
        return soft() ? 0 : share * std::max(-separation - slop * radius, 0.0);
    }
    // The speed at an impact after `gap`, from `start` on. `change` of the speed is spread over the substep. Sets the
    // time of the impact, and returns the speed.
    double speedAt(double gap, double start, double change, double h) {
        const double there = -std::sqrt(start * start - 2 * change / h * gap);
        time = std::min(-2 * gap / (start + there), h);
        return there;
    }
    // `approach`: the speed at the impact. `late`: what changes it in the rest of the substep.
    void bounce(double approach, double late) {
        impact = true;
        target = std::max(-restitution * approach + late, 0.0);
    }
    void setLoad(double carried, double impactSpeed) { load = carried > leastLoad * impactSpeed * mass ? carried : 0; }
};

double depthIn(const Wall& wall, const Sphere& sphere) {
    return sphere.radius - glm::dot(sphere.x - wall.point, wall.normal);
}

void World::substep(double h) {
    largestOverlap_ = 0;
    begin(h);
    if (contacts && order.empty())
        for (std::size_t i = 0; i < spheres.size(); ++i)
            for (std::size_t j = i + 1; j < spheres.size(); ++j) solvePair(i, j, h);
    if (contacts)
        for (const auto& [i, j] : order) solvePair(i, j, h);
    for (std::size_t i = 0; i < spheres.size(); ++i)
        for (std::size_t wall = 0; wall < walls.size(); ++wall) solveWall(i, wall, h);
    finish(h);
}

// Adds gravity and the impulses that contacts held in the last substep.
void World::begin(double h) {
    motions_.clear();
    double fastest = 0;
    double largest = 0;
    for (Sphere& sphere : spheres) {
        sphere.acceleration += (sphere.heldVelocity + gravity * h - sphere.acceleration) / meanOver;
        motions_.push_back({.start = sphere.v,
                            .unheld = sphere.v + gravity * h,
                            .unheldSpin = sphere.spin,
                            .change = std::max(glm::length(gravity) * h, glm::length(sphere.acceleration))});
        sphere.v += gravity * h + sphere.heldVelocity;
        sphere.spin += sphere.heldSpin;
        fastest = std::max(fastest, glm::length(sphere.v));
        largest = std::max(largest, sphere.radius);
    }
    farthest_ = 2 * fastest * h + slop * largest;
}

void World::solvePair(std::size_t i, std::size_t j, double h) {
    if (i > j) std::swap(i, j);
    Sphere& a = spheres[i];
    Sphere& b = spheres[j];
    const auto found = pairsHold.find({i, j});
    Contact contact{.d = a.x - b.x, .reach = a.radius + b.radius};
    if (found != pairsHold.end()) contact.held = found->second;
    const double distance = glm::length(contact.d);
    contact.separation = distance - contact.reach;
    const bool near = contact.separation < farthest_;
    if (!near && !holdsAny(contact.held)) return;
    contact.n = contact.d / distance;
    contact.mass = 1 / (a.inverseMass + b.inverseMass);
    contact.radius = std::min(a.radius, b.radius);
    contact.restitution = std::min(a.restitution, b.restitution);
    contact.friction = std::sqrt(a.friction * b.friction);
    contact.lever = distance / contact.reach;
    contact.speed = glm::dot(a.v - b.v, contact.n);
    contact.target = -std::max(contact.separation, 0.0) / h;
    largestOverlap_ = std::max(largestOverlap_, -contact.separation);
    if (near && contact.speed < contact.target && !findImpact(contact, i, j, h)) return;

    const glm::dvec3 turning = glm::cross(a.spin * a.radius + b.spin * b.radius, contact.n) * contact.lever;
    Held after;
    if (near) after = solve(contact, tangentialOf(a.v - b.v, contact.n) - turning, h);
    apply(i, contact, after, 1);
    apply(j, contact, after, -1);
    const glm::dvec3 push = contact.n * (contact.push(overlapRemoved) * contact.mass);
    a.x += push * a.inverseMass;
    b.x -= push * b.inverseMass;
    const Held kept = remembered(contact, after);
    forget(i, after, kept, 1);
    forget(j, after, kept, -1);
    pairsHold[{i, j}] = kept;
}

// Returns false if the spheres pass each other.
bool World::findImpact(Contact& contact, std::size_t i, std::size_t j, double h) {
    const Sphere& a = spheres[i];
    const Sphere& b = spheres[j];
    const double change = std::max(motions_[i].change, motions_[j].change);
    if (contact.speed >= -change) return true;
    const double limit = contact.limit(change);
    const glm::dvec3 start = motions_[i].start - motions_[j].start;
    double approach = glm::dot(start, contact.n);
    double late = std::clamp(contact.speed - approach, -change, 0.0);
    if (contact.separation > 0 && approach < -limit) {
        const glm::dvec3 path = (start + a.v - b.v) * 0.5;
        const double meeting = meetingTime(contact.d, path, contact.reach);
        const bool meets = meeting >= 0 && meeting <= h;
        if (!meets && !holdsAny(contact.held)) return false;
        if (meets) {
            contact.n = (contact.d + path * meeting) / contact.reach;
            contact.lever = 1;
            contact.speed = glm::dot(a.v - b.v, contact.n);
            contact.target = 0;
            const double before = glm::dot(start, contact.n);
            const double gains = std::clamp(contact.speed - before, -change, 0.0);
            approach = contact.speedAt(-glm::dot(path, contact.n) * meeting, before, gains, h);
            late = gains * (1 - contact.time / h);
        }
    }
    if (approach >= -limit) return true;
    contact.bounce(approach, late);
    // The impulses by which the other contacts of each sphere press it to the other one.
    const glm::dvec3 othersOnA = (a.v - motions_[i].unheld) / a.inverseMass - contact.held.impulse;
    const glm::dvec3 othersOnB = (b.v - motions_[j].unheld) / b.inverseMass + contact.held.impulse;
    contact.setLoad(std::min(-glm::dot(othersOnA, contact.n), glm::dot(othersOnB, contact.n)), -approach);
    const glm::dvec3 impulse = contact.n * (-(1 + contact.restitution) * approach * contact.mass);
    motions_[i].start += impulse * a.inverseMass;
    motions_[j].start -= impulse * b.inverseMass;
    return true;
}

void World::solveWall(std::size_t i, std::size_t wall, double h) {
    Sphere& sphere = spheres[i];
    const auto found = wallsHold.find({i, wall});
    Contact contact{.n = walls[wall].normal, .separation = -depthIn(walls[wall], sphere)};
    if (found != wallsHold.end()) contact.held = found->second;
    contact.speed = glm::dot(sphere.v, contact.n);
    const bool near = contact.separation + std::min(contact.speed, 0.0) * h <= 0;
    if (!near && !holdsAny(contact.held)) return;
    contact.mass = 1 / sphere.inverseMass;
    contact.radius = sphere.radius;
    contact.restitution = std::min(sphere.restitution, walls[wall].restitution);
    contact.friction = std::sqrt(sphere.friction * walls[wall].friction);
    contact.target = -std::max(contact.separation, 0.0) / h;
    largestOverlap_ = std::max(largestOverlap_, -contact.separation);
    if (contact.speed < contact.target && !findImpactAtWall(contact, i, h)) return;

    const glm::dvec3 turning = glm::cross(sphere.spin * sphere.radius, contact.n);
    const Held after = solve(contact, tangentialOf(sphere.v, contact.n) - turning, h);
    apply(i, contact, after, 1);
    sphere.x += contact.n * contact.push(1);
    const Held kept = remembered(contact, after);
    forget(i, after, kept, 1);
    wallsHold[{i, wall}] = kept;
}

// Returns false if the sphere does not reach the wall in this substep.
bool World::findImpactAtWall(Contact& contact, std::size_t i, double h) {
    const Sphere& sphere = spheres[i];
    Motion& motion = motions_[i];
    const double limit = contact.limit(motion.change);
    const double start = glm::dot(motion.start, contact.n);
    const double gains = std::min(contact.speed - start, 0.0);
    double approach = std::min(start, 0.0);
    double late = gains;
    if (contact.separation > 0 && approach < -limit) {
        const double mean = (start + contact.speed) / 2;
        const bool meets = mean * h <= -contact.separation;
        if (!meets && !holdsAny(contact.held)) return false;
        if (meets) {
            contact.target = 0;
            approach = contact.speedAt(contact.separation, start, gains, h);
            late = gains * (1 - contact.time / h);
        }
    }
    if (approach >= -limit) return true;
    contact.bounce(approach, late);
    const glm::dvec3 others = (sphere.v - motion.unheld) / sphere.inverseMass - contact.held.impulse;
    contact.setLoad(-glm::dot(others, contact.n), -start);
    motion.start -= contact.n * ((1 + contact.restitution) * approach);
    return true;
}

// Returns the impulse and the torque that the contact needs in all.
Held World::solve(const Contact& contact, const glm::dvec3& slip, double h) {
    const double before = contact.heldAlong();
    double normal = before - contact.mass * (contact.speed - contact.target);
    if (contact.soft()) {
        const double removed = std::max(springRemoves * contact.separation, -softest * contact.radius);
        normal = springShare * (before - contact.mass * (contact.speed + removed / h));
    }
    normal = std::max(normal, 0.0);
    glm::dvec3 friction = tangentialOf(contact.held.impulse, contact.n) - slip * (contact.mass / surface);
    const double most = contact.friction * normal;
    if (const double size = glm::length(friction); size > most) friction *= most / size;
    return {contact.n * normal + friction, glm::cross(contact.n, friction) * contact.lever};
}

// Changes the velocity by the new part of the impulse, and the place by this change from the time of the impact on.
void World::apply(std::size_t i, const Contact& contact, const Held& after, double sign) {
    Sphere& sphere = spheres[i];
    const glm::dvec3 change = (after.impulse - contact.held.impulse) * (sign * sphere.inverseMass);
    sphere.v += change;
    sphere.x -= change * contact.time;
    sphere.spin -= (after.torque - contact.held.torque) * spinOf(sphere);
}

// An impact leaves the impulse held before, and the part that an impact without restitution would have added, up to
// some loads.
Held World::remembered(const Contact& contact, const Held& after) {
    const double normal = glm::dot(after.impulse, contact.n);
    if (!contact.impact || normal <= 0) return after;
    const double before = std::max(contact.heldAlong(), 0.0);
    const double keep = before + std::min((normal - before) / (1 + contact.restitution), loadsKept * contact.load);
    const double share = std::min(keep / normal, 1.0);
    return {after.impulse * share, after.torque * share};
}

void World::forget(std::size_t i, const Held& after, const Held& kept, double sign) {
    const Sphere& sphere = spheres[i];
    motions_[i].unheld += (after.impulse - kept.impulse) * (sign * sphere.inverseMass);
    motions_[i].unheldSpin -= (after.torque - kept.torque) * spinOf(sphere);
}

// A sphere that holds nothing moves along its parabola.
void World::finish(double h) {
    std::vector<bool> holds(spheres.size());
    for (const auto& [pair, held] : pairsHold)
        if (holdsAny(held)) holds[pair.first] = holds[pair.second] = true;
    for (const auto& [contact, held] : wallsHold)
        if (holdsAny(held)) holds[contact.first] = true;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        Sphere& sphere = spheres[i];
        const Motion& motion = motions_[i];
        sphere.heldVelocity = holds[i] ? sphere.v - motion.unheld : glm::dvec3(0);
        sphere.heldSpin = holds[i] ? sphere.spin - motion.unheldSpin : glm::dvec3(0);
        sphere.x += (sphere.v - (holds[i] ? glm::dvec3(0) : gravity * (h / 2))) * h;
    }
}

std::size_t World::touchingPairs(double tolerance) const {
    std::size_t touching = 0;
    for (std::size_t i = 0; i < spheres.size(); ++i)
        for (std::size_t j = i + 1; j < spheres.size(); ++j) {
            const double reach = spheres[i].radius + spheres[j].radius;
            if (glm::length(spheres[i].x - spheres[j].x) < reach * (1 + tolerance)) ++touching;
        }
    return touching;
}

}  // namespace spherule::reference
