#include "diagnostics/overlap_watch.h"

#include <spdlog/fmt/fmt.h>

#include <utility>

namespace spherule::diagnostics {

namespace {

constexpr double tolerated = 0.5;
constexpr std::size_t quietReadings = 10;

}  // namespace

std::optional<std::string> OverlapWatch::check(std::uint64_t step, double largest) {
    if (!(largest > tolerated)) {
        if (reported_ && ++quiet_ >= quietReadings) reported_ = false;
        return std::nullopt;
    }
    quiet_ = 0;
    if (std::exchange(reported_, true)) return std::nullopt;
    return fmt::format(
        "at step {}, spheres are in each other, or in a wall, by up to {:.2g} radii: the model is beyond its range "
        "here; "
        "use more substeps or another model",
        step, largest);
}

}  // namespace spherule::diagnostics
