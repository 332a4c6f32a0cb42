#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace spherule::quality {

// Notices when mechanical energy rises though nothing can have given it. Where contacts store energy that a reading
// does not show, one that is low for a moment proves nothing: a rise is one above the highest of several. Elsewhere one
// reading is enough until there are several.
class EnergyWatch {
  public:
    struct Reading {
        std::uint64_t step = 0;
        double kinetic = 0;    // J, of motion and rotation
        double potential = 0;  // J, zero at the lowest place of the scene
        double elastic = 0;    // J, in the springs of soft spheres
        double given = 0;      // J, of pushes out of walls, which are known to give some
        bool soft = false;     // contacts hold energy that the others do not show
    };

    // A message about a rise, once until there has been none for a while.
    std::optional<std::string> take(const Reading& reading);
    // A command, or more substeps, may have added energy: earlier readings are discarded.
    void disturbed();
    // Nothing to compare with has been read.
    [[nodiscard]] bool fresh() const { return recent_.empty(); }
    [[nodiscard]] bool alarmed() const { return alarmed_; }

  private:
    struct Seen {
        double energy = 0;  // J
        bool soft = false;
    };

    std::deque<Seen> recent_;
    std::optional<double> ceiling_;  // J: the lowest that the highest of several in a row has been
    bool alarmed_ = false;
    std::size_t quiet_ = 0;  // readings since the last rise
};

}  // namespace spherule::quality
