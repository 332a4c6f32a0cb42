#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

// The reference for the simulation: the contact laws in double, for all pairs, one after another. It is written after
// the description of the laws, not after the kernels.
namespace spherule::reference {

struct Sphere {
    glm::dvec3 x{};          // m
    glm::dvec3 v{};          // m/s
    double radius = 0;       // m
    double inverseMass = 0;  // 1/kg
    double restitution = 0;
};

// A wall: the half-space behind `point` is solid.
struct Wall {
    glm::dvec3 point{};
    glm::dvec3 normal{};  // unit length, towards the free side
    double restitution = 0;
};

class World {
  public:
    std::vector<Sphere> spheres;
    std::vector<Wall> walls;
    glm::dvec3 gravity{};
    bool contacts = true;                                    // false: spheres do not collide with each other
    std::vector<std::pair<std::size_t, std::size_t>> order;  // order of the pairs; empty: all pairs, by index

    // Advances by h seconds.
    void substep(double h);

    // Figures of the last substep. An overlap (m) is measured when it is corrected.
    [[nodiscard]] double largestOverlap() const { return largestOverlap_; }
    [[nodiscard]] std::size_t touchingPairs() const { return touching_.size(); }

  private:
    void fly(double h);
    void separatePairs(double h);
    void separatePair(std::size_t i, std::size_t j, double h);
    void separateFromWalls(double h);
    void bouncePairs();
    void bounceFromWalls();
    void bouncePair(std::size_t i, std::size_t j);
    void bounceAtWall(std::size_t i, const Wall& wall);
    void hitWall(std::size_t i, const Wall& wall, double depth, double h);

    std::vector<glm::dvec3> u_;  // velocities before the substep, updated after each impact
    std::vector<std::pair<std::size_t, std::size_t>> touching_;
    double largestOverlap_ = 0;
    bool anythingBounces_ = false;
};

// Returns the depth (m) of a sphere in a wall; negative: the gap.
double depthIn(const Wall& wall, const Sphere& sphere);

}  // namespace spherule::reference
