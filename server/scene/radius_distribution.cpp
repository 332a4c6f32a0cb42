#include "scene/radius_distribution.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

void readLimits(Check& check, double min, double max, std::string_view field, RadiusDistribution& radii) {
    radii.min = readRadius(check, min, at(field, "min"));
    radii.max = readRadius(check, max, at(field, "max"));
    if (radii.min >= radii.max) check.refuse(at(field, "max"), fmt::format("is {}, must be above min, {}", max, min));
}

void readNormal(Check& check, const v1::Normal& normal, std::string_view field, RadiusDistribution& radii) {
    readLimits(check, normal.min(), normal.max(), field, radii);
    if (!check.ok()) return;
    // With these limits at least a third of the draws lies within min..max.
    const double mean = check.within(normal.mean(), radii.min, radii.max, at(field, "mean"), " (min to max)");
    const double deviation = check.upTo(normal.deviation(), radii.max - radii.min, at(field, "deviation"),
                                        " (max - min; for a wider one use uniform)");
    radii.kind = RadiusDistribution::Normal{mean, deviation};
}

void readLogNormal(Check& check, const v1::LogNormal& message, std::string_view field, RadiusDistribution& radii) {
    readLimits(check, message.min(), message.max(), field, radii);
    if (!check.ok()) return;
    // As for a normal distribution: ln(min)..ln(max) contains ln(median) and is a deviation wide or wider, so at least
    // the 0.341 between median and median + deviation lies within.
    const double median = check.within(message.median(), radii.min, radii.max, at(field, "median"), " (min to max)");
    const double deviation = check.upTo(message.deviation(), std::log(radii.max / radii.min), at(field, "deviation"),
                                        " (ln(max / min); for a wider one use a table)");
    radii.kind = RadiusDistribution::LogNormal{median, deviation};
}

void readTable(Check& check, const v1::RadiusTable& table, std::string_view field, RadiusDistribution& radii) {
    constexpr int fewest = 2;
    constexpr int most = 64;
    const std::string radiiField = at(field, "radii");
    const std::string sharesField = at(field, "shares");
    if (table.radii_size() < fewest || table.radii_size() > most)
        return check.refuse(radiiField,
                            fmt::format("has {} numbers, must have {} to {}", table.radii_size(), fewest, most));
    if (table.shares_size() != table.radii_size())
        return check.refuse(sharesField, fmt::format("has {} numbers, must have one for each of the {} radii",
                                                     table.shares_size(), table.radii_size()));
    for (int i = 0; i < table.radii_size(); ++i) {
        const auto index = static_cast<std::size_t>(i);
        readRadius(check, table.radii(i), at(radiiField, index));
        check.within(table.shares(i), 0, 1, at(sharesField, index));
        if (i == 0) continue;
        if (table.radii(i) <= table.radii(i - 1))
            check.refuse(at(radiiField, index), fmt::format("is {}, must be above the radius before it, {}",
                                                            table.radii(i), table.radii(i - 1)));
        if (table.shares(i) < table.shares(i - 1))
            check.refuse(at(sharesField, index), fmt::format("is {}, must be at least the share before it, {}",
                                                             table.shares(i), table.shares(i - 1)));
    }
    if (table.shares(0) != 0)
        check.refuse(at(sharesField, 0), fmt::format("is {}, must be 0: no sphere is smaller than the first radius; "
                                                     "begin with the smallest radius",
                                                     table.shares(0)));
    const auto last = static_cast<std::size_t>(table.shares_size() - 1);
    if (*table.shares().rbegin() != 1)
        check.refuse(at(sharesField, last),
                     fmt::format("is {}, must be 1: no sphere is larger than the last radius; end "
                                 "with the largest radius",
                                 *table.shares().rbegin()));
    if (!check.ok()) return;
    radii.min = table.radii(0);
    radii.max = *table.radii().rbegin();
    radii.kind =
        SieveCurve(table.by_mass() ? SieveCurve::Of::Mass : SieveCurve::Of::Number,
                   {table.radii().begin(), table.radii().end()}, {table.shares().begin(), table.shares().end()});
}

// Draws one radius (m), perhaps outside min..max.
struct Draw {
    Random& random;
    double min;
    double max;

    double operator()(const RadiusDistribution::Uniform&) const { return random.uniform(min, max); }
    double operator()(const RadiusDistribution::Normal& normal) const {
        return normal.mean + normal.deviation * random.normal();
    }
    double operator()(const RadiusDistribution::LogNormal& law) const {
        constexpr double most = 700;  // beyond max / min of any radii
        return law.median * portableExp(std::clamp(law.deviation * random.normal(), -most, most));
    }
    double operator()(const SieveCurve& curve) const { return curve.draw(random); }
};

// Returns the mean of a function of a normal number z that is cut to low..high. By Simpson's rule: the error is below
// 1e-6 for r^3 of every distribution that readNormal() and readLogNormal() accept.
template <class Of>
double meanOverNormal(double low, double high, Of of) {
    constexpr double tail = 12;
    constexpr int intervals = 2000;  // even
    low = std::max(low, -tail);
    high = std::min(high, tail);
    double sum = 0;
    double weights = 0;
    for (int k = 0; k <= intervals; ++k) {
        const double z = low + (high - low) * k / intervals;
        const double simpson = k == 0 || k == intervals ? 1 : k % 2 == 1 ? 4 : 2;
        const double weight = simpson * portableExp(-0.5 * z * z);
        sum += weight * of(z);
        weights += weight;
    }
    return sum / weights;
}

double cubed(double r) {
    return r * r * r;
}

// Returns ln x of a ratio of radii, with the same bits with every mathematical library.
double naturalLog(double x) {
    double low = -30;
    double high = 30;
    for (int k = 0; k < 64; ++k) {
        const double middle = 0.5 * (low + high);
        (portableExp(middle) < x ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace

double RadiusDistribution::meanCube() const {
    if (min == max) return cubed(min);
    if (const auto* const law = std::get_if<Normal>(&kind))
        return meanOverNormal((min - law->mean) / law->deviation, (max - law->mean) / law->deviation,
                              [&](double z) { return cubed(law->mean + law->deviation * z); });
    if (const auto* const law = std::get_if<LogNormal>(&kind)) {
        const double low = naturalLog(min / law->median) / law->deviation;
        const double high = naturalLog(max / law->median) / law->deviation;
        return cubed(law->median) *
               meanOverNormal(low, high, [&](double z) { return cubed(portableExp(law->deviation * z)); });
    }
    if (const auto* const curve = std::get_if<SieveCurve>(&kind)) return curve->meanCube();
    return 0.25 * (min + max) * (min * min + max * max);
}

float RadiusDistribution::draw(Random& random) const {
    if (min == max) return static_cast<float>(min);
    for (;;) {
        const double radius = std::visit(Draw{random, min, max}, kind);
        if (radius >= min && radius <= max) return static_cast<float>(radius);
    }
}

double readRadius(Check& check, double value, std::string_view field) {
    check.part([&] {
        check.positive(value, field);
        if (check.ok()) check.within(value, smallestRadius, largestRadius, field, " m");
    });
    return std::isfinite(value) ? std::clamp(value, smallestRadius, largestRadius) : smallestRadius;
}

RadiusDistribution readRadiusDistribution(Check& check, const v1::Radius& message, std::string_view field) {
    RadiusDistribution radii;
    switch (message.kind_case()) {
        case v1::Radius::kConstant:
            radii.min = radii.max = readRadius(check, message.constant(), at(field, "constant"));
            break;
        case v1::Radius::kUniform:
            readLimits(check, message.uniform().min(), message.uniform().max(), at(field, "uniform"), radii);
            break;
        case v1::Radius::kNormal:
            readNormal(check, message.normal(), at(field, "normal"), radii);
            break;
        case v1::Radius::kLogNormal:
            readLogNormal(check, message.log_normal(), at(field, "logNormal"), radii);
            break;
        case v1::Radius::kTable:
            readTable(check, message.table(), at(field, "table"), radii);
            break;
        case v1::Radius::KIND_NOT_SET:
            check.refuse(std::string(field), "is empty, must be one of constant, uniform, normal, logNormal, table");
            break;
    }
    return radii;
}

}  // namespace spherule::scene
