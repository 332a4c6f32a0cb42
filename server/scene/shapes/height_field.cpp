#include <algorithm>
#include <filesystem>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "scene/check.h"
#include "scene/mesh/height_grid.h"
#include "scene/mesh/mesh.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

constexpr std::size_t mostInlineHeights = longestInlineMesh / sizeof(double);

HeightGrid inlineGrid(Check& check, const v1::HeightField& field, const std::string& here) {
    if (static_cast<std::size_t>(field.heights_size()) > mostInlineHeights)
        check.refuse(at(here, "heights"),
                     fmt::format("has {} numbers, must have at most {}; name a file in place of it",
                                 field.heights_size(), mostInlineHeights));
    if (field.columns() < 2 || static_cast<std::uint32_t>(field.heights_size()) % field.columns() != 0)
        check.refuse(at(here, "columns"),
                     fmt::format("is {} for {} heights, must divide their number, and be at least 2", field.columns(),
                                 field.heights_size()));
    HeightGrid grid{.columns = field.columns()};
    if (!check.ok()) return grid;
    for (int k = 0; k < field.heights_size(); ++k)
        grid.heights.push_back(check.finite(field.heights(k), at(at(here, "heights"), static_cast<std::size_t>(k))));
    return grid;
}

HeightGrid gridOf(Check& check, v1::HeightField& field, const Box& box, const std::string& here,
                  const ShapeInput& input) {
    if (field.file().empty() == field.heights().empty()) {
        check.refuse(at(here, "file"), field.file().empty()
                                           ? "is missing; name a CSV or PNG file, or give `heights` and `columns`"
                                           : "is given with `heights`; leave one of them out");
        return {};
    }
    if (field.file().empty()) return inlineGrid(check, field, here);
    const auto bytes = readMeshFile(check, input.directory, field.file(), at(here, "file"));
    if (!bytes) return {};
    field.set_file(std::filesystem::absolute(*input.directory / field.file()).lexically_normal().string());
    const MeshBytes from{at(here, "file"), field.file(), *bytes};
    HeightGrid grid = readHeights(check, from, box.min.z, box.max.z);
    if (check.ok() && (grid.columns < 2 || grid.rows() < 2))
        from.refuse(check, "",
                    fmt::format("has {} by {} heights, must have at least 2 by 2", grid.columns, grid.rows()));
    // A scene that is saved has what is short.
    if (check.ok() && grid.heights.size() <= mostInlineHeights) {
        field.clear_file();
        field.set_columns(grid.columns);
        field.mutable_heights()->Assign(grid.heights.begin(), grid.heights.end());
    }
    return grid;
}

ShapePointer read(Check& check, const v1::Obstacle& message, const std::string& field, const ShapeInput& input) {
    v1::Obstacle kept;
    v1::HeightField& heights = *kept.mutable_height_field();
    heights = message.height_field();
    if (input.mesh) return meshShape(input.mesh, kept);
    const std::string here = at(field, "heightField");
    const Box box = check.box(heights.min(), heights.max(), here);
    const glm::dvec3 side = box.max - box.min;
    double depth = 0.1 * std::max({side.x, side.y, side.z});
    if (heights.depth() != 0) depth = check.upTo(heights.depth(), largestComponent, at(here, "depth"), " m");
    if (!check.ok()) return nullptr;
    const HeightGrid grid = gridOf(check, heights, box, here, input);
    if (check.ok() && grid.rows() < 2)
        check.refuse(at(here, "heights"), fmt::format("has {} rows, must have at least 2", grid.rows()));
    for (std::size_t k = 0; k < grid.heights.size() && check.ok(); ++k)
        if (!(grid.heights[k] >= box.min.z && grid.heights[k] <= box.max.z))
            check.refuse(
                here, fmt::format("has the height {:.6g} m in row {}, column {}, must be between min z = {:.6g} "
                                  "and max z = {:.6g}",
                                  grid.heights[k], k / grid.columns + 1, k % grid.columns + 1, box.min.z, box.max.z));
    if (!check.ok()) return nullptr;
    const auto mesh = Mesh::make(check, {here, "", {}}, groundOf(grid, box, box.min.z - depth),
                                 {.form = Mesh::Form::Solid, .longestSide = input.longestSide});
    return mesh ? meshShape(mesh, kept) : nullptr;
}

}  // namespace

const ShapeType shapesHeightFields{
    .field = v1::Obstacle::kHeightField,
    .read = read,
    .example = nullptr,
};

}  // namespace spherule::scene
