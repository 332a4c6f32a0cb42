#include "codec/rendition.h"

#include <algorithm>

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

}  // namespace spherule::codec
