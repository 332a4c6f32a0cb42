#include "codec/rendition.h"

#include <algorithm>
#include <bit>

#include "codec/format.h"

namespace spherule::codec {

std::uint32_t rateFor(std::uint32_t asked) {
    if (asked == 0) return 0;
    const auto above = std::ranges::upper_bound(rates, asked);
    return above == rates.begin() ? rates.front() : *(above - 1);
}

double quantumOf(v1::Tier tier, double smallestRadius) {
    const double errors = tier == v1::FINE ? 500 : tier == v1::ECO ? 16 : 50;
    return 2 * smallestRadius / errors;
}

double unitOfSpeed(double smallestRadius) {
    constexpr double radiiPerSecond = 0.01;
    return radiiPerSecond * smallestRadius;
}

double speedOf(std::uint32_t code, double unit) {
    if (code == 0) return 0;
    const std::uint32_t middle = (code << speedShift) + (1U << (speedShift - 1));
    return unit * (static_cast<double>(std::bit_cast<float>(std::bit_cast<std::uint32_t>(1.0F) + middle)) - 1);
}

}  // namespace spherule::codec
