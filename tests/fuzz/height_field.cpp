// Fuzzes the readers of height fields, CSV and PNG, and the ground that is made of the heights.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scene/mesh/height_grid.h"
#include "scene/mesh/mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule::scene;
    Check check;
    const MeshBytes from{"heightField", "", std::string_view(reinterpret_cast<const char*>(data), size)};
    const HeightGrid grid = readHeights(check, from, 0, 1);
    constexpr std::size_t few = 10'000;  // more would only be slow
    if (!check.ok() || grid.columns < 2 || grid.rows() < 2 || grid.heights.size() > few) return 0;
    (void)Mesh::make(check, from, groundOf(grid, {{0, 0, 0}, {1, 1, 1}}, -1e9 - 1), {.form = Mesh::Form::Solid});
    return 0;
}
