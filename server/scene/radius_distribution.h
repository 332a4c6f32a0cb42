#pragma once

#include <string_view>
#include <variant>

#include "scene/random.h"
#include "scene/sieve_curve.h"

namespace spherule::v1 {
class Radius;
}

namespace spherule::scene {

class Check;

constexpr double smallestRadius = 1e-6;  // m
constexpr double largestRadius = 1e6;    // m

// A validated distribution of radii within min..max; the same radius always if both are equal.
struct RadiusDistribution {
    struct Uniform {};

    // Drawn again outside min..max.
    struct Normal {
        double mean = 0;       // m
        double deviation = 0;  // m
    };

    // ln r is normal. Drawn again outside min..max.
    struct LogNormal {
        double median = 0;     // m
        double deviation = 0;  // of ln r
    };

    double min = 0;  // m
    double max = 0;  // m
    std::variant<Uniform, Normal, LogNormal, SieveCurve> kind;

    // A constant distribution draws no random number.
    [[nodiscard]] float draw(Random& random) const;

    // Returns the mean of r^3 (m^3), with the same bits with every compiler and mathematical library.
    [[nodiscard]] double meanCube() const;
};

// Reads a single radius (m).
double readRadius(Check& check, double value, std::string_view field);

RadiusDistribution readRadiusDistribution(Check& check, const v1::Radius& message, std::string_view field);

}  // namespace spherule::scene
