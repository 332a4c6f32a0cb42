#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

// The contact laws once more, in double, all pairs, one after the other: what the simulation is compared with. Written
// from the description of the laws, not from the kernels.
namespace spherule::reference {

struct Sphere {
    glm::dvec3 x{};          // m
    glm::dvec3 v{};          // m/s
    double radius = 0;       // m
    double inverseMass = 0;  // 1/kg
    double restitution = 0;
};

// The half-space behind `point` is solid.
struct Wall {
    glm::dvec3 point{};
    glm::dvec3 normal{};  // unit length, to the free side
    double restitution = 0;
};

class World {
  public:
    std::vector<Sphere> spheres;
    std::vector<Wall> walls;
    glm::dvec3 gravity{};
    bool contacts = true;                                    // of spheres with each other
    std::vector<std::pair<std::size_t, std::size_t>> order;  // in which pairs are taken; empty: by index, all of them

    // Advances by h seconds.
    void substep(double h);

    // Of the last substep: overlaps as they were when they were corrected, in m.
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

    std::vector<glm::dvec3> u_;  // the running velocity: before the substep, then after each impact
    std::vector<std::pair<std::size_t, std::size_t>> touching_;
    double largestOverlap_ = 0;
    bool anythingBounces_ = false;
};

// How deep a sphere is in a wall, in m; negative: the gap.
double depthIn(const Wall& wall, const Sphere& sphere);

}  // namespace spherule::reference
