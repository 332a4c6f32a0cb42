#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/quality.h"

namespace spherule::quality {

// Measured over some steps.
struct Reading {
    double stepMs = 0;  // wall time, mean
    std::uint64_t contacts = 0;
    double overlapMean = 0;  // of the radius
};

struct Decision {
    std::uint32_t substeps = 0;  // from now on; may be as before, when there is only something to say
    std::string text;
};

// Moves substeps to hold a goal. One reading beyond the goal moves nothing; several in a row do. In a band below the
// goal nothing moves, so substeps do not oscillate.
class AutoQuality {
  public:
    AutoQuality(scene::Goal goal, scene::SubstepRange range) : goal_(goal), range_(range) {}

    // The reading of steps with `substeps` substeps.
    std::optional<Decision> take(const Reading& reading, std::uint32_t substeps);

  private:
    [[nodiscard]] bool readable(const Reading& reading) const;
    [[nodiscard]] double overGoal(const Reading& reading) const;
    [[nodiscard]] std::uint32_t wanted(double over, std::uint32_t substeps) const;
    [[nodiscard]] std::string toldOf(const Reading& reading) const;

    scene::Goal goal_;
    scene::SubstepRange range_;
    int missed_ = 0;  // readings in a row
    int easy_ = 0;
    bool gaveUp_ = false;  // it has been said that the goal is out of reach
};

}  // namespace spherule::quality
