#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <glm/vec3.hpp>

namespace spherule::scene {

// Spheres by place, to ask whether another fits between them. One hash grid for each size class (powers of two), so
// that large among many small ones costs no more than equal ones.
class Occupancy {
  public:
    // `expected` spheres, none larger than `largest` (m), are quick; more or larger ones are slower, not wrong.
    Occupancy(std::size_t expected, double largest);

    void add(const glm::dvec3& centre, double radius);

    // No sphere overlaps this one. Touching is free.
    [[nodiscard]] bool isFree(const glm::dvec3& centre, double radius);

    // Cells and spheres looked at so far: what the questions have cost.
    [[nodiscard]] std::uint64_t work() const { return work_; }

  private:
    struct Item {
        glm::dvec3 centre;
        double radius;
        std::uint32_t next;  // in the same chain
    };
    struct Level {
        double cell = 0;                   // m, as wide as the largest sphere of the class
        std::vector<std::uint32_t> heads;  // chains by hash of the cell
        std::vector<Item> items;
    };

    [[nodiscard]] std::size_t slotOf(const glm::dvec3& cell) const;
    [[nodiscard]] bool isFreeIn(const Level& level, const glm::dvec3& centre, double radius);

    std::map<int, Level> levels_;
    std::size_t slots_;
    double largest_;
    std::uint64_t work_ = 0;
};

}  // namespace spherule::scene
