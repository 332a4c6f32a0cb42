#include "scene/random.h"

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

}  // namespace spherule::scene
