#include "sim/features.h"

#include "sim/modules/module.h"

namespace spherule::sim {

std::string_view nameOf(Feature feature) {
    constexpr std::string_view names[] = {
#define FEATURE(flag, Name, text) text,
#include "features.def"
#undef FEATURE
    };
    return names[static_cast<std::size_t>(feature)];
}

std::vector<Feature> allFeatures() {
    return {
#define FEATURE(flag, Name, text) Feature::Name,
#include "features.def"
#undef FEATURE
    };
}

Features featuresOf(const scene::Scene& scene) {
    Features features;
    for (const Module* module : modules()) features.set(module->feature, module->required(scene, features));
    return features;
}

std::vector<compute::Define> definesFor(const Features& features) {
    const auto value = [&](Feature feature) { return features.has(feature) ? "true" : "false"; };
    return {
#define FEATURE(flag, Name, text) {#flag, value(Feature::Name)},
#include "features.def"
#undef FEATURE
    };
}

}  // namespace spherule::sim
