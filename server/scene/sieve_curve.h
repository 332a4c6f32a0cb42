#pragma once

#include <cstdint>
#include <vector>

#include "scene/random.h"

namespace spherule::scene {

// A distribution of radii by a cumulative curve, linear between its points. Draws have the same bits with every
// compiler and mathematical library.
class SieveCurve {
  public:
    enum class Of : std::uint8_t { Number, Mass };

    SieveCurve() = default;  // without radii: to be filled by archive()

    // `radii` (m): at least two, each above the one before. `shares`: for each radius, the share of all spheres (their
    // number or their mass) that are at most so large: from 0 to 1, none below the one before.
    // Between two points a and b a curve of mass has a mass per radius that is constant. So its number per radius falls
    // with r^-3, and the number between a and b is proportional to (share of mass) (a + b) / (a b)^2.
    SieveCurve(Of of, std::vector<double> radii, const std::vector<double>& shares);

    // Returns a radius (m).
    [[nodiscard]] double draw(Random& random) const;
    [[nodiscard]] double meanCube() const;  // mean of r^3 (m^3)
    template <class Archive>
    void archive(Archive& a) {
        a(of_, radii_, numbers_);
    }

  private:
    Of of_ = Of::Number;
    std::vector<double> radii_;
    std::vector<double> numbers_;  // below each radius, in any unit
};

}  // namespace spherule::scene
