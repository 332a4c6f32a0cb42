#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

// The reference for the simulation: the contact law of `balanced` in double, one contact after another. It is written
// after the description of the law, not after the kernels. It has no sleep and no rolling resistance.
namespace spherule::reference {

struct Sphere {
    glm::dvec3 x{};          // m
    glm::dvec3 v{};          // m/s
    double radius = 0;       // m
    double inverseMass = 0;  // 1/kg
    double restitution = 0;
    double friction = 0;
    glm::dvec3 spin{};          // rad/s
    glm::dvec3 heldVelocity{};  // m/s: change by the impulses that contacts hold
    glm::dvec3 heldSpin{};      // rad/s: change by the torques that contacts hold
    glm::dvec3 acceleration{};  // m/s: change of the velocity in a substep, running mean
};

// A wall: the half-space behind `point` is solid.
struct Wall {
    glm::dvec3 point{};
    glm::dvec3 normal{};  // unit length, towards the free side
    double restitution = 0;
    double friction = 0;
};

// The impulse that a contact holds from one substep to the next.
struct Held {
    glm::dvec3 impulse{};  // N s, on the first body
    glm::dvec3 torque{};   // N s: torque of the friction, per lever of a sphere
};

class World {
  public:
    using Pair = std::pair<std::size_t, std::size_t>;

    std::vector<Sphere> spheres;
    std::vector<Wall> walls;
    glm::dvec3 gravity{};
    bool contacts = true;            // false: spheres do not collide with each other
    std::vector<Pair> order;         // order of the pairs; empty: all pairs, by index
    std::map<Pair, Held> pairsHold;  // by the indices of two spheres, the lower one first
    std::map<Pair, Held> wallsHold;  // by the indices of sphere and wall

    // Advances by h seconds.
    void substep(double h);

    // The largest overlap (m) that a contact had when it was solved in the last substep.
    [[nodiscard]] double largestOverlap() const { return largestOverlap_; }
    // Pairs that touch or overlap now. `tolerance`: gap up to which spheres touch, over the sum of their radii.
    [[nodiscard]] std::size_t touchingPairs(double tolerance = 1e-4) const;

  private:
    // Values of a sphere in the substep under way.
    struct Motion {
        glm::dvec3 start{};       // m/s: velocity before the substep, then after impacts
        glm::dvec3 unheld{};      // m/s: velocity without held impulses
        glm::dvec3 unheldSpin{};  // rad/s
        double change = 0;        // m/s: by the sphere's own acceleration in a substep
    };
    struct Contact;

    void begin(double h);
    void solvePair(std::size_t i, std::size_t j, double h);
    void solveWall(std::size_t i, std::size_t wall, double h);
    bool findImpact(Contact& contact, std::size_t i, std::size_t j, double h);
    bool findImpactAtWall(Contact& contact, std::size_t i, double h);
    static Held solve(const Contact& contact, const glm::dvec3& slip, double h);
    static Held remembered(const Contact& contact, const Held& after);
    void apply(std::size_t i, const Contact& contact, const Held& after, double sign);
    void forget(std::size_t i, const Held& after, const Held& kept, double sign);
    void finish(double h);

    std::vector<Motion> motions_;
    double farthest_ = 0;  // m: pairs with a wider gap cannot meet in this substep
    double largestOverlap_ = 0;
};

// Returns the depth (m) of a sphere in a wall; negative: the gap.
double depthIn(const Wall& wall, const Sphere& sphere);

}  // namespace spherule::reference
