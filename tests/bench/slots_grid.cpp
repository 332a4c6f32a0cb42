#include <algorithm>
#include <cmath>

#include "methods.h"

namespace spherule::bench {

Result<std::unique_ptr<Baseline>> slotsGrid(const Setting& setting, const SlotsGrid& grid) {
    const std::uint32_t cells = grid.cells.x * grid.cells.y * grid.cells.z;
    Setting with = setting;
    with.parameters.cells = glm::uvec4(grid.cells, cells);
    auto method = std::make_unique<Baseline>(with, Baseline::State::PingPong);
    compute::Buffer* const occupied = method->array("counters of the cells", std::size_t{cells} * 4);
    compute::Buffer* const slots = method->array("slots of the cells", std::size_t{cells} * grid.slots * 4);
    method->stage("clear.comp", {occupied}, cells, cells);
    method->define("SLOTS", std::to_string(grid.slots) + "u");
    method->define("LOCAL_SIZE", std::to_string(grid.localSize));
    method->stage("slots_fill.comp", {method->position(0), occupied, slots, method->tallyArray()},
                  setting.parameters.spheres);
    method->response("slots_respond.comp", {occupied, slots});
    if (auto ready = method->ready(); !ready) return tl::unexpected(ready.error());
    return method;
}

SlotsGrid studentGrid(const Setting& setting) {
    return {glm::uvec3(8), setting.parameters.spheres, 1};
}

SlotsGrid fineGrid(const Setting& setting, std::uint32_t localSize) {
    SlotsGrid grid{glm::uvec3(1), 64, localSize};
    for (int axis = 0; axis < 3; ++axis) {
        const float extent = setting.parameters.wallMax[axis] - setting.parameters.wallMin[axis];
        // A cell must be at least as wide as a sphere; otherwise contacts would be missed.
        grid.cells[axis] =
            static_cast<std::uint32_t>(std::max(1.0F, std::floor(extent / (2 * setting.parameters.radius))));
    }
    return grid;
}

}  // namespace spherule::bench
