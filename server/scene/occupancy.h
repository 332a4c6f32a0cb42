#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace spherule::scene {

// Finds whether a sphere fits between others. Has one hash grid for each size class (powers of two), so that a large
// sphere among many small ones costs no more than equal spheres.
class Occupancy {
  public:
    // Fastest if the largest radius is `typical` (m). Spheres have images along the periodic axes of `bounds`.
    explicit Occupancy(double typical, const Bounds& bounds = {}) : typical_(typical), bounds_(bounds) {}

    void add(const glm::dvec3& centre, double radius);
    [[nodiscard]] std::size_t size() const { return size_; }
    // Returns the largest memory per sphere (bytes), which is reached while the grid grows.
    [[nodiscard]] static std::size_t mostBytesPerSphere();

    // Returns true if no sphere overlaps this one. Touching is no overlap. The centres of all spheres are in the bounds
    // along the periodic axes.
    [[nodiscard]] bool isFree(const glm::dvec3& centre, double radius);

    // Cells and spheres visited so far, as a measure of the work. A caller may add its own work.
    [[nodiscard]] std::uint64_t work() const { return work_; }
    // Takes away the sphere that was added last.
    void dropLast(const glm::dvec3& centre, double radius);
    void addWork(std::uint64_t work) { work_ += work; }

  private:
    struct Item {
        glm::dvec3 centre;
        double radius;
        std::uint32_t next;  // in the same chain
    };
    struct Level {
        double cell = 0;                   // m, as wide as the largest sphere of the class
        std::vector<std::uint32_t> heads;  // chains by hash of the cell, at least one for each item
        std::vector<Item> items;
    };

    // Class k holds the radii above typical / 2^(k+1), up to typical / 2^k.
    [[nodiscard]] int classOf(double radius) const { return std::ilogb(typical_ / radius); }
    [[nodiscard]] static std::size_t slotOf(const Level& level, const glm::dvec3& cell);
    static void link(Level& level, std::size_t item);
    [[nodiscard]] bool isFreeIn(const Level& level, const glm::dvec3& centre, double radius);
    [[nodiscard]] bool isImageFreeIn(const Level& level, const glm::dvec3& centre, double radius);

    std::map<int, Level> levels_;
    double typical_;
    Bounds bounds_;
    std::size_t size_ = 0;
    std::uint64_t work_ = 0;
};

}  // namespace spherule::scene
