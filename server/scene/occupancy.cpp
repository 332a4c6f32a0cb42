#include "scene/occupancy.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace spherule::scene {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

bool overlap(const glm::dvec3& a, double radiusA, const glm::dvec3& b, double radiusB) {
    const glm::dvec3 d = a - b;
    const double reach = radiusA + radiusB;
    return glm::dot(d, d) < reach * reach;
}

}  // namespace

Occupancy::Occupancy(std::size_t expected, double largest)
    : slots_(std::bit_ceil(std::max<std::size_t>(expected, 64))), largest_(largest) {}

// Cells that follow each other in x have slots that do so too: a row of them is one place in memory.
std::size_t Occupancy::slotOf(const glm::dvec3& cell) const {
    const auto integer = [](double value) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(value)); };
    std::uint64_t hash = integer(cell.y) * 0x9e3779b97f4a7c15U;
    hash = (hash ^ (hash >> 32U) ^ integer(cell.z)) * 0xbf58476d1ce4e5b9U;
    return static_cast<std::size_t>(((hash ^ (hash >> 32U)) + integer(cell.x)) & (slots_ - 1));
}

void Occupancy::add(const glm::dvec3& centre, double radius) {
    // Class k holds the radii above largest / 2^(k+1), up to largest / 2^k.
    const int sizeClass = std::ilogb(largest_ / radius);
    Level& level = levels_[sizeClass];
    if (level.heads.empty()) {
        level.cell = std::ldexp(2 * largest_, -sizeClass);
        level.heads.assign(slots_, none);
    }
    std::uint32_t& head = level.heads[slotOf(glm::floor(centre / level.cell))];
    level.items.push_back({centre, radius, head});
    head = static_cast<std::uint32_t>(level.items.size() - 1);
}

bool Occupancy::isFreeIn(const Level& level, const glm::dvec3& centre, double radius) {
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
                for (auto i = level.heads[slotOf(cell)]; i != none; i = level.items[i].next, ++work_) {
                    if (overlap(level.items[i].centre, level.items[i].radius, centre, radius)) return false;
                }
            }
        }
    }
    return true;
}

bool Occupancy::isFree(const glm::dvec3& centre, double radius) {
    return std::all_of(levels_.begin(), levels_.end(),
                       [&](const auto& entry) { return isFreeIn(entry.second, centre, radius); });
}

}  // namespace spherule::scene
