#include "scene/portable_exp.h"

#include <cmath>
#include <numbers>

namespace spherule::scene {

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
