#include "reference.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace spherule::reference {

namespace {

constexpr double atWall = 2e-4;  // gap / radius up to which a sphere counts as at a wall

// Changes the relative velocity of the pair by `change`, shared by inverse mass.
void share(glm::dvec3& a, glm::dvec3& b, double inverseMassA, double inverseMassB, const glm::dvec3& change) {
    const double sum = inverseMassA + inverseMassB;
    a += change * (inverseMassA / sum);
    b -= change * (inverseMassB / sum);
}

}  // namespace

double depthIn(const Wall& wall, const Sphere& sphere) {
    return sphere.radius - glm::dot(sphere.x - wall.point, wall.normal);
}

void World::substep(double h) {
    touching_.clear();
    largestOverlap_ = 0;
    const auto bounces = [](const auto& thing) { return thing.restitution > 0; };
    anythingBounces_ = std::ranges::any_of(spheres, bounces) || std::ranges::any_of(walls, bounces);
    fly(h);
    if (contacts) separatePairs(h);
    separateFromWalls(h);
    bouncePairs();
    bounceFromWalls();
}

void World::fly(double h) {
    u_.clear();
    for (Sphere& sphere : spheres) {
        u_.push_back(sphere.v);
        sphere.v += gravity * h;
        sphere.x += sphere.v * h - gravity * (h * h / 2);
    }
}

void World::separatePairs(double h) {
    for (const auto& [i, j] : order) separatePair(i, j, h);
    if (!order.empty()) return;
    for (std::size_t i = 0; i < spheres.size(); ++i)
        for (std::size_t j = i + 1; j < spheres.size(); ++j) separatePair(i, j, h);
}

void World::separatePair(std::size_t i, std::size_t j, double h) {
    Sphere& a = spheres[i];
    Sphere& b = spheres[j];
    const glm::dvec3 line = a.x - b.x;
    const double distance = glm::length(line);
    const double overlap = a.radius + b.radius - distance;
    if (overlap <= 0) return;
    const glm::dvec3 push = line / distance * overlap;
    share(a.x, b.x, a.inverseMass, b.inverseMass, push);
    share(a.v, b.v, a.inverseMass, b.inverseMass, push / h);
    touching_.emplace_back(i, j);
    largestOverlap_ = std::max(largestOverlap_, overlap);
}

void World::separateFromWalls(double h) {
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        for (const Wall& wall : walls) {
            const double depth = depthIn(wall, spheres[i]);
            if (depth <= -atWall * spheres[i].radius) continue;
            largestOverlap_ = std::max(largestOverlap_, depth);
            hitWall(i, wall, depth, h);
        }
    }
}

void World::hitWall(std::size_t i, const Wall& wall, double depth, double h) {
    Sphere& sphere = spheres[i];
    const double e = std::min(sphere.restitution, wall.restitution);
    const double pull = glm::dot(gravity, wall.normal);
    const double before = glm::dot(u_[i], wall.normal);
    const double gap = std::max(0.0, -depth - (before * h + pull * h * h / 2));
    const double impact = std::sqrt(std::max(0.0, before * before - 2 * pull * gap));
    if (depth > 0 || before < 0) u_[i] += wall.normal * (e * impact - before);

    const double push = std::max(depth, 0.0);
    sphere.x += wall.normal * push;
    const double speed = glm::dot(sphere.v, wall.normal);
    const double raised = std::max(speed, std::min(speed + push / h, 0.0));
    sphere.v += wall.normal * (raised - speed);
}

void World::bouncePairs() {
    for (const auto& [i, j] : touching_) bouncePair(i, j);
}

void World::bouncePair(std::size_t i, std::size_t j) {
    Sphere& a = spheres[i];
    Sphere& b = spheres[j];
    const glm::dvec3 n = glm::normalize(a.x - b.x);
    const double speed = glm::dot(a.v - b.v, n);
    const double approach = glm::dot(u_[i] - u_[j], n);
    double wanted = 0;
    if (approach < 0) {
        wanted = -std::min(a.restitution, b.restitution) * approach;
        share(u_[i], u_[j], a.inverseMass, b.inverseMass, n * (wanted - approach));
    } else {
        wanted = std::clamp(speed, 0.0, approach);
    }
    share(a.v, b.v, a.inverseMass, b.inverseMass, n * (wanted - speed));
}

void World::bounceFromWalls() {
    for (std::size_t i = 0; i < spheres.size(); ++i)
        for (const Wall& wall : walls)
            if (depthIn(wall, spheres[i]) > -atWall * spheres[i].radius) bounceAtWall(i, wall);
}

void World::bounceAtWall(std::size_t i, const Wall& wall) {
    Sphere& sphere = spheres[i];
    const double speed = glm::dot(sphere.v, wall.normal);
    const double running = glm::dot(u_[i], wall.normal);
    double wanted = running;
    if (!anythingBounces_) {
        wanted = std::max(speed, 0.0);
    } else if (running < 0) {
        wanted = -std::min(sphere.restitution, wall.restitution) * running;
        u_[i] += wall.normal * (wanted - running);
    }
    sphere.v += wall.normal * (wanted - speed);
}

}  // namespace spherule::reference
