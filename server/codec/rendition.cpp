#include "codec/rendition.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <numbers>

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

double unitOf(v1::Quantity quantity, double smallestRadius) {
    constexpr double smallestUnit = 1e-30;  // within float32
    constexpr double speed = 0.01;          // radii per second
    constexpr double density = 1000;        // kg/m^3
    switch (quantity) {
        case v1::SPEED:
            return speed * smallestRadius;
        case v1::OVERLAP:
            return 1e-4;
        case v1::ENERGY: {
            // The energy of the smallest sphere, made of water, at 10 units of speed.
            const double mass = 4.0 / 3 * std::numbers::pi * density * std::pow(smallestRadius, 3);
            return std::max(0.5 * mass * std::pow(10 * speed * smallestRadius, 2), smallestUnit);
        }
        default:
            return 1;  // a number
    }
}

namespace {

// `shift`: the bits of a float that the code leaves out.
double magnitudeOf(std::uint32_t code, std::uint32_t shift, double unit) {
    if (code == 0) return 0;
    const std::uint32_t middle = (code << shift) + (1U << (shift - 1));
    return unit * (static_cast<double>(std::bit_cast<float>(std::bit_cast<std::uint32_t>(1.0F) + middle)) - 1);
}

}  // namespace

double valueOf(std::uint32_t code, double unit) {
    return magnitudeOf(code, valueShift, unit);
}

double spinOf(std::int32_t code, double unit) {
    const double magnitude = magnitudeOf(static_cast<std::uint32_t>(std::abs(code)), spinShift, unit);
    return code < 0 ? -magnitude : magnitude;
}

}  // namespace spherule::codec
