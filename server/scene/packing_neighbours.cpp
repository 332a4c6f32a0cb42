#include "scene/packing_neighbours.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

namespace spherule::scene {

namespace {

constexpr double surfaceWork = 10;  // of a distance from a surface; a pair has 1

}  // namespace

PackingNeighbours::PackingNeighbours(std::vector<double> radii, std::size_t movable, double reach,
                                     const PackingSpace& space)
    : radii_(std::move(radii)), movable_(movable), reach_(reach), space_(space) {
    for (int axis = 0; axis < 3; ++axis)
        halfPeriods_[axis] =
            space.periods[axis] > 0 ? 0.5 * space.periods[axis] : std::numeric_limits<double>::infinity();
    std::map<int, std::vector<std::uint32_t>, std::greater<>> byExponent;
    for (std::uint32_t i = 0; i < radii_.size(); ++i) byExponent[std::ilogb(radii_[i])].push_back(i);
    for (auto& [exponent, members] : byExponent) {
        double largest = 0;
        for (const std::uint32_t i : members) largest = std::max(largest, radii_[i]);
        SizeClass& one = classes_.emplace_back();
        one.members = std::move(members);
        divide(one, 2 * largest * reach_);
    }
    first_.resize(radii_.size() + 1);
    anchors_.resize(movable_);
    clear_.assign(movable_, -std::numeric_limits<double>::infinity());
}

// Divides the box into cells of at least this width, about as many as there are spheres.
void PackingNeighbours::divide(SizeClass& one, double widest) const {
    const glm::dvec3 side = space_.box.max - space_.box.min;
    const double most = 4 * static_cast<double>(one.members.size()) + 64;
    for (double width = widest;; width *= 1.25) {
        double all = 1;
        for (int axis = 0; axis < 3; ++axis) all *= std::max(1.0, std::floor(side[axis] / width));
        if (all > most) continue;
        for (int axis = 0; axis < 3; ++axis) {
            const double cells = std::max(1.0, std::floor(side[axis] / width));
            one.cells[static_cast<std::size_t>(axis)] = static_cast<int>(cells);
            one.cellsPerLength[axis] = cells / side[axis];
        }
        break;
    }
    one.first.resize(static_cast<std::size_t>(one.cells[0]) * static_cast<std::size_t>(one.cells[1]) *
                         static_cast<std::size_t>(one.cells[2]) +
                     1);
    one.sorted.resize(one.members.size());
    one.cellOf.resize(one.members.size());
}

// A place outside the box belongs to the nearest cell: two places come no farther apart by that.
std::array<int, 3> PackingNeighbours::cellAt(const SizeClass& one, const glm::dvec3& place) const {
    std::array<int, 3> cell{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const double x = place[axis] - space_.box.min[axis];
        cell[k] = static_cast<int>(std::clamp(x * one.cellsPerLength[axis], 0.0, one.cells[k] - 1.0));
    }
    return cell;
}

void PackingNeighbours::sort(SizeClass& one, std::span<const glm::dvec3> places) const {
    std::ranges::fill(one.first, 0U);
    for (std::size_t m = 0; m < one.members.size(); ++m) {
        const std::array<int, 3> cell = cellAt(one, places[one.members[m]]);
        one.cellOf[m] = static_cast<std::uint32_t>((cell[2] * one.cells[1] + cell[1]) * one.cells[0] + cell[0]);
        ++one.first[one.cellOf[m] + 1];
    }
    for (std::size_t k = 1; k < one.first.size(); ++k) one.first[k] += one.first[k - 1];
    // Each cell is filled from its end, so that `first` becomes its beginning.
    for (std::size_t m = one.members.size(); m-- > 0;) one.sorted[--one.first[one.cellOf[m] + 1]] = one.members[m];
    for (std::size_t k = 0; k + 1 < one.first.size(); ++k) one.first[k] = one.first[k + 1];
    one.first.back() = static_cast<std::uint32_t>(one.members.size());
}

void PackingNeighbours::findIn(const SizeClass& one, std::uint32_t i, bool same, std::span<const glm::dvec3> places) {
    const std::array<int, 3> cell = cellAt(one, places[i]);
    // The neighbours along each axis: each cell once, also across a seam.
    std::array<std::array<int, 3>, 3> along{};
    std::array<std::size_t, 3> count{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int cells = one.cells[axis];
        const bool periodic = space_.periods[static_cast<int>(axis)] > 0;
        for (int step = -1; step <= 1; ++step) {
            int k = cell[axis] + step;
            if (periodic) k = (k + cells) % cells;
            if (k < 0 || k >= cells) continue;
            bool seen = false;
            for (std::size_t m = 0; m < count[axis]; ++m) seen = seen || along[axis][m] == k;
            if (!seen) along[axis][count[axis]++] = k;
        }
    }
    for (std::size_t z = 0; z < count[2]; ++z)
        for (std::size_t y = 0; y < count[1]; ++y)
            for (std::size_t x = 0; x < count[0]; ++x) {
                const auto slot =
                    static_cast<std::size_t>((along[2][z] * one.cells[1] + along[1][y]) * one.cells[0] + along[0][x]);
                for (std::uint32_t m = one.first[slot]; m < one.first[slot + 1]; ++m) {
                    const std::uint32_t j = one.sorted[m];
                    if ((same && j >= i) || (i >= movable_ && j >= movable_)) continue;
                    const glm::dvec3 d = apart(places[i], places[j]);
                    const double near = reach_ * (radii_[i] + radii_[j]);
                    if (glm::dot(d, d) < near * near) others_.push_back(j);
                }
                work_ += one.first[slot + 1] - one.first[slot];
            }
}

void PackingNeighbours::findSurfaces(std::span<const glm::dvec3> places) {
    atSurfaces_.clear();
    for (std::uint32_t i = 0; i < movable_; ++i) {
        const double near = reach_ * radii_[i];
        if (glm::distance(places[i], anchors_[i]) + near < clear_[i]) continue;
        clear_[i] = std::numeric_limits<double>::infinity();
        anchors_[i] = places[i];
        for (std::uint32_t k = 0; k < space_.surfaces.size(); ++k) {
            const double distance = space_.surfaces[k](places[i]);
            clear_[i] = std::min(clear_[i], distance);
            if (distance < near) atSurfaces_.push_back({i, k});
        }
        work_ += surfaceWork * static_cast<double>(space_.surfaces.size());
    }
}

bool PackingNeighbours::find(std::span<const glm::dvec3> places) {
    for (SizeClass& one : classes_) sort(one, places);
    others_.clear();
    const std::size_t most = mostPairs * radii_.size();
    std::vector<const SizeClass*> own(radii_.size());
    for (const SizeClass& one : classes_)
        for (const std::uint32_t i : one.members) own[i] = &one;
    for (std::uint32_t i = 0; i < radii_.size(); ++i) {
        first_[i] = static_cast<std::uint32_t>(others_.size());
        for (const SizeClass& one : classes_) {
            findIn(one, i, &one == own[i], places);
            if (&one == own[i]) break;
        }
        if (others_.size() > most) return false;
    }
    first_.back() = static_cast<std::uint32_t>(others_.size());
    findSurfaces(places);
    return true;
}

}  // namespace spherule::scene
