#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace spherule::diagnostics {

// Detects overlaps of spheres, or of spheres and walls, that are too large for the model.
class OverlapWatch {
  public:
    // `largest`: largest overlap / (smaller) radius. Returns a message; nullopt if the overlap is tolerable, or was
    // reported recently.
    std::optional<std::string> check(std::uint64_t step, double largest);

  private:
    bool reported_ = false;
    std::size_t quiet_ = 0;  // readings since the last overlap that was too large
};

}  // namespace spherule::diagnostics
