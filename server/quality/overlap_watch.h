#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace spherule::quality {

// Notices when spheres are so deep in each other, or in a wall, that the model does not hold them apart any more.
class OverlapWatch {
  public:
    // `largest`: overlap over the (smaller) radius. Returns a message, once until there has been none for a while.
    std::optional<std::string> take(std::uint64_t step, double largest);

  private:
    bool told_ = false;
    std::size_t quiet_ = 0;  // readings without
};

}  // namespace spherule::quality
