#include "encode/morton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace spherule::encode {

namespace {

constexpr float lastCell = 65535;

// Moves bit b to bit 3 b.
std::uint64_t apart(std::uint64_t x) {
    x = (x | x << 32U) & 0x00ff00000000ffffU;
    x = (x | x << 16U) & 0x00ff0000ff0000ffU;
    x = (x | x << 8U) & 0xf00f00f00f00f00fU;
    x = (x | x << 4U) & 0x30c30c30c30c30c3U;
    return (x | x << 2U) & 0x9249249249249249U;
}

}  // namespace

std::vector<std::uint32_t> mortonOrder(std::span<const glm::vec4> positions) {
    constexpr float most = std::numeric_limits<float>::max();
    float low[3] = {most, most, most};
    float extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
        float high = -most;
        for (const glm::vec4& p : positions) {
            if (!std::isfinite(p[axis])) continue;
            low[axis] = std::min(low[axis], p[axis]);
            high = std::max(high, p[axis]);
        }
        extent = std::max(extent, high - low[axis]);
    }
    const float scale = extent > 0 ? lastCell / extent : 0;
    const auto cell = [&](float x, int axis) {
        const float place = (x - low[axis]) * scale;
        return place > 0 ? static_cast<std::uint64_t>(std::min(place, lastCell)) : 0;
    };
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(positions.size());
    for (std::uint32_t k = 0; k < keys.size(); ++k) {
        const glm::vec4& p = positions[k];
        keys[k] = {apart(cell(p.x, 0)) | apart(cell(p.y, 1)) << 1U | apart(cell(p.z, 2)) << 2U, k};
    }
    std::ranges::sort(keys);
    std::vector<std::uint32_t> order(keys.size());
    std::ranges::transform(keys, order.begin(), [](const auto& key) { return key.second; });
    return order;
}

}  // namespace spherule::encode
