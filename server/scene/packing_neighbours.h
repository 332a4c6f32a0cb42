#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/packing.h"

namespace spherule::scene {

// The pairs of spheres that are near each other, and the spheres that are near surfaces. Spheres are sorted into cells
// by classes of size, so that a small sphere looks for larger ones in their cells and never the other way round.
class PackingNeighbours {
  public:
    static constexpr std::size_t mostPairs = 48;  // per sphere

    // `movable`: the spheres from this number on are fixed. `reach`: two spheres are near if they are no farther apart
    // than this times the sum of their radii. `space` must outlive it.
    PackingNeighbours(std::vector<double> radii, std::size_t movable, double reach, const PackingSpace& space);

    struct NearSurface {
        std::uint32_t sphere = 0;
        std::uint32_t surface = 0;
    };
    // Finds them at these places, which are in the box along periodic axes. Returns false if there are more than
    // mostPairs for each sphere.
    bool find(std::span<const glm::dvec3> places);

    // Returns the spheres near sphere `i`; each pair is found from one of its spheres.
    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t i) const {
        return {others_.data() + first_[i], first_[i + 1] - first_[i]};
    }
    [[nodiscard]] const std::vector<NearSurface>& atSurfaces() const { return atSurfaces_; }
    [[nodiscard]] const std::vector<double>& radii() const { return radii_; }
    // Returns the vector from b to the nearest image of a. Both are at most half a period outside the box.
    [[nodiscard]] glm::dvec3 apart(const glm::dvec3& a, const glm::dvec3& b) const {
        glm::dvec3 d = a - b;
        for (int axis = 0; axis < 3; ++axis) {
            if (d[axis] > halfPeriods_[axis]) d[axis] -= space_.periods[axis];
            if (d[axis] < -halfPeriods_[axis]) d[axis] += space_.periods[axis];
        }
        return d;
    }
    // Returns the work since it was made: about one for each pair of spheres compared, more for distances from
    // surfaces.
    [[nodiscard]] double work() const { return work_; }

  private:
    // The spheres whose radii are within a factor of two.
    struct SizeClass {
        std::vector<std::uint32_t> members{};
        glm::dvec3 cellsPerLength{};       // 1/m
        std::array<int, 3> cells{};        // along each axis
        std::vector<std::uint32_t> first;  // of each cell in `sorted`, and the end
        std::vector<std::uint32_t> sorted;
        std::vector<std::uint32_t> cellOf;  // of `members`
    };
    void divide(SizeClass& one, double widest) const;
    [[nodiscard]] std::array<int, 3> cellAt(const SizeClass& one, const glm::dvec3& place) const;
    void sort(SizeClass& one, std::span<const glm::dvec3> places) const;
    void findIn(const SizeClass& one, std::uint32_t i, bool same, std::span<const glm::dvec3> places);
    void findSurfaces(std::span<const glm::dvec3> places);

    std::vector<double> radii_;
    std::size_t movable_;
    double reach_;
    const PackingSpace& space_;
    glm::dvec3 halfPeriods_{};        // infinity for axes that are not periodic
    std::vector<SizeClass> classes_;  // by falling radius
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> others_;
    std::vector<NearSurface> atSurfaces_;
    std::vector<glm::dvec3> anchors_;  // where `clear_` was found
    std::vector<double> clear_;        // m: distance from the nearest surface
    double work_ = 0;
};

}  // namespace spherule::scene
