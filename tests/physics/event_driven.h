#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

// The reference for gases: equal hard spheres without friction in a closed box, in double. Each impact happens at its
// exact time and place.
namespace spherule::reference {

struct HardSphere {
    glm::dvec3 x{};  // m, at the time of its last impact
    glm::dvec3 v{};  // m/s
};

class HardSphereGas {
  public:
    // The box has its centre at the origin. `side`: of the box (m); `radius`: of the spheres (m).
    HardSphereGas(std::vector<HardSphere> spheres, double side, double radius, double pairRestitution,
                  double wallRestitution);

    void run(double seconds);

    [[nodiscard]] double meanSquaredSpeed() const;  // (m/s)^2
    // Since the start.
    [[nodiscard]] std::size_t pairImpacts() const { return pairImpacts_; }
    [[nodiscard]] std::size_t wallImpacts() const { return wallImpacts_; }
    // Sums of magnitudes, per mass of a sphere (m/s).
    [[nodiscard]] double pairImpulse() const { return pairImpulse_; }
    [[nodiscard]] double wallImpulse() const { return wallImpulse_; }

  private:
    struct Event {
        double time = 0;       // s
        std::size_t with = 0;  // a sphere, or an axis after the last sphere
    };

    [[nodiscard]] glm::dvec3 placeOf(std::size_t k, double time) const;
    [[nodiscard]] double timeOfImpact(std::size_t a, std::size_t b) const;
    void listNeighbours();
    void predict(std::size_t k);
    void collide(std::size_t k);

    std::vector<HardSphere> spheres_;
    std::vector<double> movedAt_;  // s, of the last impact of each sphere
    std::vector<Event> next_;      // of each sphere
    std::vector<std::vector<std::size_t>> neighbours_;
    double speedLimit_ = 0;   // m/s, for which the neighbours are listed
    double listedUntil_ = 0;  // s
    double margin_;           // m
    double reach_;            // largest coordinate of a centre (m)
    double diameter_;         // m
    double pairRestitution_;
    double wallRestitution_;
    double time_ = 0;  // s
    std::size_t pairImpacts_ = 0;
    std::size_t wallImpacts_ = 0;
    double pairImpulse_ = 0;  // m/s
    double wallImpulse_ = 0;  // m/s
};

}  // namespace spherule::reference
