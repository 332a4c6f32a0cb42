#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "compute/device.h"
#include "scene/scene.h"

namespace spherule::sim {

// The features that a scene may require: the rows of shaders/features.def. A feature that the scene does not require is
// neither compiled, allocated nor launched.
enum class Feature : std::uint8_t {
#define FEATURE(flag, Name, text) Name,
#include "features.def"
#undef FEATURE
};

constexpr std::size_t featureCount = 0
#define FEATURE(flag, Name, text) +1
#include "features.def"
#undef FEATURE
    ;
static_assert(featureCount <= 64, "Features has 64 bits");

std::string_view nameOf(Feature feature);
std::vector<Feature> allFeatures();

class Features {
  public:
    [[nodiscard]] bool has(Feature feature) const { return (bits_ & bitOf(feature)) != 0; }
    void set(Feature feature, bool on = true) { bits_ = on ? bits_ | bitOf(feature) : bits_ & ~bitOf(feature); }

    // Returns true if the scene has any surface that a sphere may hit.
    [[nodiscard]] bool hasSurfaceFeature() const { return has(Feature::Walls) || has(Feature::Obstacles); }

    [[nodiscard]] bool hasAll(const Features& others) const { return (others.bits_ & ~bits_) == 0; }
    bool operator==(const Features&) const = default;
    template <class Archive>
    void archive(Archive& a) {
        a(bits_);
    }

  private:
    static std::uint64_t bitOf(Feature feature) { return std::uint64_t{1} << static_cast<unsigned>(feature); }

    std::uint64_t bits_ = 0;
};

// Returns the features that a scene with its spheres requires, except Levels: planFor() sets it with the grid.
Features featuresOf(const scene::Scene& scene);

// Returns one define per feature for the kernels, with the value "true" or "false".
std::vector<compute::Define> definesFor(const Features& features);

}  // namespace spherule::sim
