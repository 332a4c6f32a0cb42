#include "scene/random.h"

#include <cmath>
#include <numbers>

namespace spherule::scene {

namespace {

// The finaliser of SplitMix64: neighbouring seeds and streams start the engine in unrelated states.
std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) : engine_(mix(mix(seed) + stream)) {}

double Random::uniform() {
    return static_cast<double>(engine_() >> 11U) * 0x1p-53;
}

double Random::uniform(double low, double high) {
    return low + (high - low) * uniform();
}

bool Random::withProbabilityOfExpMinus(double t) {
    // The chance of a falling run t > u1 > u2 > ... of length n is t^n / n!, so an even length has the chance exp(-t).
    bool even = true;
    double last = t;
    double next = uniform();
    while (next < last) {
        even = !even;
        last = next;
        next = uniform();
    }
    return even;
}

double Random::normal() {
    for (;;) {
        int whole = 0;
        while (withProbabilityOfExpMinus(0.5)) ++whole;
        // Accept `whole` = k with probability exp(-k(k-1)/2), then the fraction x with exp(-x(2k+x)/2).
        bool accepted = true;
        for (int i = 0; accepted && i < whole * (whole - 1); ++i) accepted = withProbabilityOfExpMinus(0.5);
        if (!accepted) continue;
        const double fraction = uniform();
        const double exponent = fraction * (2 * whole + fraction) / (2 * whole + 2);
        for (int i = 0; accepted && i <= whole; ++i) accepted = withProbabilityOfExpMinus(exponent);
        if (!accepted) continue;
        const double size = whole + fraction;
        return uniform() < 0.5 ? -size : size;
    }
}

double portableExp(double x) {
    // ln 2 in two parts: a multiple of the first, which has few digits, is exact.
    constexpr double ln2High = 6.93145751953125e-1;
    constexpr double ln2Low = 1.42860682030941723212e-6;
    const double power = std::floor(std::numbers::log2e * x + 0.5);
    const double rest = (x - power * ln2High) - power * ln2Low;  // |rest| <= ln(2) / 2
    // exp(r) = 1 + 2 r P(r^2) / (Q(r^2) - r P(r^2))
    const double square = rest * rest;
    const double p = ((1.26177193074810590878e-4 * square + 3.02994407707441961300e-2) * square + 1.0) * rest;
    const double q =
        ((3.00198505138664455042e-6 * square + 2.52448340349684104192e-3) * square + 2.27265548208155028766e-1) *
            square +
        2.0;
    return std::ldexp(1 + 2 * (p / (q - p)), static_cast<int>(power));
}

}  // namespace spherule::scene
