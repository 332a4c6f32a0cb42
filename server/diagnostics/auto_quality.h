#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/quality.h"

namespace spherule::diagnostics {

// Figures measured over some steps.
struct Reading {
    double stepMs = 0;  // wall time, mean
    std::uint64_t contacts = 0;
    double overlapMean = 0;  // mean overlap / radius
};

struct Decision {
    std::uint32_t substeps = 0;  // from now on; unchanged if the decision only has a message
    std::string text;
};

// Adjusts the substeps to hold a goal. It acts after several readings beyond the goal in a row, not after one. In a
// band below the goal it changes nothing, so that substeps do not oscillate.
class AutoQuality {
  public:
    AutoQuality() = default;  // without a goal: to be filled by archive()
    AutoQuality(scene::QualityGoal goal, scene::SubstepRange range) : goal_(goal), range_(range) {}

    // Takes a reading of steps with this number of substeps. Returns nullopt if nothing changes.
    std::optional<Decision> take(const Reading& reading, std::uint32_t substeps);
    template <class Archive>
    void archive(Archive& a) {
        a(goal_.kind, goal_.max, range_.fewest, range_.most, missed_, easy_, gaveUp_);
    }

  private:
    [[nodiscard]] bool readable(const Reading& reading) const;
    [[nodiscard]] double overGoal(const Reading& reading) const;
    [[nodiscard]] std::uint32_t wanted(double over, std::uint32_t substeps) const;
    [[nodiscard]] std::string describe(const Reading& reading) const;

    scene::QualityGoal goal_;
    scene::SubstepRange range_;
    int missed_ = 0;  // readings in a row
    int easy_ = 0;
    bool gaveUp_ = false;  // it has reported that the goal is out of reach
};

}  // namespace spherule::diagnostics
