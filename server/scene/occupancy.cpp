#include "scene/occupancy.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace spherule::scene {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

bool overlap(const glm::dvec3& a, double radiusA, const glm::dvec3& b, double radiusB) {
    const glm::dvec3 d = a - b;
    const double reach = radiusA + radiusB;
    return glm::dot(d, d) < reach * reach;
}

}  // namespace

// Successive cells in x have successive slots, so a row of cells is contiguous in memory.
std::size_t Occupancy::slotOf(const Level& level, const glm::dvec3& cell) {
    // A sphere that has left the bounds may have any coordinates.
    const auto integer = [](double value) {
        return static_cast<std::uint64_t>(std::abs(value) < 0x1p62 ? static_cast<std::int64_t>(value) : 0);
    };
    std::uint64_t hash = integer(cell.y) * 0x9e3779b97f4a7c15U;
    hash = (hash ^ (hash >> 32U) ^ integer(cell.z)) * 0xbf58476d1ce4e5b9U;
    return static_cast<std::size_t>(((hash ^ (hash >> 32U)) + integer(cell.x)) & (level.heads.size() - 1));
}

void Occupancy::add(const glm::dvec3& centre, double radius) {
    constexpr std::size_t fewest = 64;
    const int sizeClass = classOf(radius);
    Level& level = levels_[sizeClass];
    level.cell = std::ldexp(2 * typical_, -sizeClass);
    level.items.push_back({centre, radius, none});
    ++size_;
    if (level.items.size() <= level.heads.size()) return link(level, level.items.size() - 1);
    level.heads.assign(std::max(fewest, 2 * level.heads.size()), none);
    for (std::size_t k = 0; k < level.items.size(); ++k) link(level, k);
}

// It is the first of its chain.
void Occupancy::dropLast(const glm::dvec3& centre, double radius) {
    Level& level = levels_[classOf(radius)];
    level.heads[slotOf(level, glm::floor(centre / level.cell))] = level.items.back().next;
    level.items.pop_back();
    --size_;
}

// Items twice, and chains of the old and the new size.
std::size_t Occupancy::mostBytesPerSphere() {
    return 2 * sizeof(Item) + 3 * sizeof(std::uint32_t);
}

void Occupancy::link(Level& level, std::size_t item) {
    std::uint32_t& head = level.heads[slotOf(level, glm::floor(level.items[item].centre / level.cell))];
    level.items[item].next = std::exchange(head, static_cast<std::uint32_t>(item));
}

bool Occupancy::isImageFreeIn(const Level& level, const glm::dvec3& centre, double radius) {
    const glm::dvec3 reach(radius + 0.5 * level.cell);
    const glm::dvec3 low = glm::floor((centre - reach) / level.cell);
    const glm::dvec3 high = glm::floor((centre + reach) / level.cell);
    const glm::dvec3 cells = high - low + 1.0;
    if (cells.x * cells.y * cells.z > static_cast<double>(level.items.size())) {
        work_ += level.items.size();
        return std::none_of(level.items.begin(), level.items.end(),
                            [&](const Item& item) { return overlap(item.centre, item.radius, centre, radius); });
    }
    glm::dvec3 cell{};
    for (cell.z = low.z; cell.z <= high.z; ++cell.z) {
        for (cell.y = low.y; cell.y <= high.y; ++cell.y) {
            for (cell.x = low.x; cell.x <= high.x; ++cell.x) {
                ++work_;
                for (auto i = level.heads[slotOf(level, cell)]; i != none; i = level.items[i].next, ++work_) {
                    if (overlap(level.items[i].centre, level.items[i].radius, centre, radius)) return false;
                }
            }
        }
    }
    return true;
}

// Looks at all images of the sphere that reach spheres in the bounds.
bool Occupancy::isFreeIn(const Level& level, const glm::dvec3& centre, double radius) {
    if (!bounds_.anyPeriodic()) return isImageFreeIn(level, centre, radius);
    const double reach = radius + 0.5 * level.cell;
    const glm::dvec3 periods = bounds_.periods();
    std::array<std::vector<double>, 3> places;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double>& along = places[static_cast<std::size_t>(axis)];
        along.push_back(centre[axis]);
        if (!(periods[axis] > 0)) continue;
        if (centre[axis] - reach < bounds_.min[axis]) along.push_back(centre[axis] + periods[axis]);
        if (centre[axis] + reach > bounds_.max[axis]) along.push_back(centre[axis] - periods[axis]);
    }
    for (const double x : places[0])
        for (const double y : places[1])
            for (const double z : places[2])
                if (!isImageFreeIn(level, {x, y, z}, radius)) return false;
    return true;
}

bool Occupancy::isFree(const glm::dvec3& centre, double radius) {
    return std::all_of(levels_.begin(), levels_.end(),
                       [&](const auto& entry) { return isFreeIn(entry.second, centre, radius); });
}

}  // namespace spherule::scene
