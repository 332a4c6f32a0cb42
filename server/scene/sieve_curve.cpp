#include "scene/sieve_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spherule::scene {

SieveCurve::SieveCurve(Of of, std::vector<double> radii, const std::vector<double>& shares)
    : of_(of), radii_(std::move(radii)), numbers_(radii_.size()) {
    for (std::size_t i = 1; i < radii_.size(); ++i) {
        const double a = radii_[i - 1] / radii_[0];
        const double b = radii_[i] / radii_[0];
        const double perShare = of_ == Of::Mass ? (a + b) / (a * a * b * b) : 1;
        numbers_[i] = numbers_[i - 1] + (shares[i] - shares[i - 1]) * perShare;
    }
}

double SieveCurve::draw(Random& random) const {
    const double below = random.uniform() * numbers_.back();
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(numbers_, below) - numbers_.begin());
    const std::size_t i = std::min(above, numbers_.size() - 1);
    const double a = radii_[i - 1];
    const double b = radii_[i];
    const double part = random.uniform();
    if (of_ == Of::Number) return std::min(a + (b - a) * part, b);
    // Inverts the cumulative number, which is linear in r^-2. IEEE 754 rounds the square root exactly.
    const double ratio = a / b;
    return std::min(a / std::sqrt(1 - part * (1 - ratio * ratio)), b);
}

double SieveCurve::meanCube() const {
    double sum = 0;
    for (std::size_t i = 1; i < radii_.size(); ++i) {
        const double a = radii_[i - 1];
        const double b = radii_[i];
        // The number per radius is constant, or falls with r^-3.
        const double cube = of_ == Of::Number ? 0.25 * (a + b) * (a * a + b * b) : 2 * a * (a / (a + b)) * b * b;
        sum += (numbers_[i] - numbers_[i - 1]) / numbers_.back() * cube;
    }
    return sum;
}

}  // namespace spherule::scene
