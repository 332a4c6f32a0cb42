#include "scene/radius_distribution.h"

#include <spdlog/fmt/fmt.h>

#include <string>

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
    // With these limits at least a third of the draws lies within min..max.
    const double mean = check.within(normal.mean(), radii.min, radii.max, at(field, "mean"), " (min to max)");
    const double deviation = check.upTo(normal.deviation(), radii.max - radii.min, at(field, "deviation"),
                                        " (max - min; for a wider one use uniform)");
    radii.bell = RadiusDistribution::Bell{mean, deviation};
}

}  // namespace

float RadiusDistribution::draw(Random& random) const {
    if (min == max) return static_cast<float>(min);
    if (!bell) return static_cast<float>(random.uniform(min, max));
    for (;;) {
        const double radius = bell->mean + bell->deviation * random.normal();
        if (radius >= min && radius <= max) return static_cast<float>(radius);
    }
}

double readRadius(Check& check, double value, std::string_view field) {
    return check.within(check.positive(value, field), smallestRadius, largestRadius, field, " m");
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
        case v1::Radius::KIND_NOT_SET:
            check.refuse(std::string(field), "is empty, must be one of constant, uniform, normal");
            break;
    }
    return radii;
}

}  // namespace spherule::scene
