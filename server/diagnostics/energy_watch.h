#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace spherule::diagnostics {

// Detects that mechanical energy rises without a source. Readings of soft contacts may be low for a moment, because
// contacts store energy that readings do not show. So a rise is measured from the highest of several readings. For
// other contacts, fewer readings suffice at the start.
class EnergyWatch {
  public:
    struct Reading {
        std::uint64_t step = 0;
        double kinetic = 0;    // J, of motion and rotation
        double potential = 0;  // J, of gravity and fields
        double fields = 0;     // J, its part in fields
        double elastic = 0;    // J, in the springs of soft spheres
        double given = 0;      // J, added by pushes out of walls, and by gravity along periodic axes
        bool soft = false;     // contacts store energy that the other fields do not include
    };

    // Returns a message about a rise; nullopt if there is none, or if a rise was reported recently.
    std::optional<std::string> check(const Reading& reading);
    // A command, or more substeps, may have added energy: earlier readings are discarded.
    void invalidateBaseline();
    // Returns true if there is no earlier reading to compare with.
    [[nodiscard]] bool fresh() const { return recent_.empty(); }
    [[nodiscard]] bool alarmed() const { return alarmed_; }

  private:
    struct Seen {
        double energy = 0;  // J
        bool soft = false;
    };

    std::deque<Seen> recent_;
    std::optional<double> ceiling_;  // J: the smallest maximum of several readings in a row
    bool alarmed_ = false;
    std::size_t quiet_ = 0;  // readings since the last rise
};

}  // namespace spherule::diagnostics
