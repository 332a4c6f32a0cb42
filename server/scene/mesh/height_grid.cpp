#include "scene/mesh/height_grid.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

#include "scene/mesh/png.h"

namespace spherule::scene {

namespace {

HeightGrid readCsv(Check& check, const MeshBytes& from) {
    HeightGrid grid;
    MeshWords words(from.bytes);
    while (check.ok() && words.nextLine()) {
        const std::size_t before = grid.heights.size();
        for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
            // Numbers are separated by commas, semicolons or blanks.
            for (std::size_t begin = 0; begin < word.size();) {
                const std::size_t end = std::min(word.find_first_of(",;", begin), word.size());
                if (end > begin) {
                    const auto value = meshNumber(check, from, words, word.substr(begin, end - begin));
                    if (!value) return grid;
                    grid.heights.push_back(*value);
                }
                begin = end + 1;
            }
            if (grid.heights.size() > mostHeights) {
                from.refuse(check, words.where(),
                            fmt::format("is beyond the {} heights that are allowed", mostHeights));
                return grid;
            }
        }
        const std::size_t count = grid.heights.size() - before;
        if (count == 0) continue;
        if (grid.columns == 0) grid.columns = static_cast<std::uint32_t>(count);
        if (count != grid.columns)
            from.refuse(check, words.where(),
                        fmt::format("has {} heights, must have {} as the first line", count, grid.columns));
        constexpr std::size_t interval = 256;
        if (words.lines() % interval == 0 && !check.goesOn("reading heights", words.place(), from.bytes.size())) break;
    }
    return grid;
}

HeightGrid fromImage(const GreyImage& image, double low, double high) {
    HeightGrid grid{.columns = image.columns};
    grid.heights.reserve(image.values.size());
    for (std::uint32_t row = image.rows; row-- > 0;)
        for (std::uint32_t column = 0; column < image.columns; ++column)
            grid.heights.push_back(low + (high - low) * image.values[std::size_t{row} * image.columns + column]);
    return grid;
}

}  // namespace

HeightGrid readHeights(Check& check, const MeshBytes& from, double low, double high) {
    constexpr std::string_view png = "\x89PNG\r\n\x1a\n";
    if (!from.bytes.starts_with(png)) return readCsv(check, from);
    const auto image = readPng(from.bytes, mostHeights);
    if (image) return fromImage(*image, low, high);
    from.refuse(check, "", image.error().message);
    return {};
}

Triangles groundOf(const HeightGrid& grid, const Box& box, double bottom) {
    Triangles ground;
    const std::uint32_t columns = grid.columns;
    const auto rows = static_cast<std::uint32_t>(grid.rows());
    const auto share = [](double low, double high, std::uint32_t k, std::uint32_t count) {
        return k + 1 == count ? high : low + (high - low) * k / (count - 1);
    };
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t column = 0; column < columns; ++column)
            ground.vertices.emplace_back(share(box.min.x, box.max.x, column, columns),
                                         share(box.min.y, box.max.y, row, rows), grid.heights[ground.vertices.size()]);
    const auto at = [&](std::uint32_t column, std::uint32_t row) { return row * columns + column; };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { ground.corners.push_back({a, b, c}); };
    for (std::uint32_t row = 0; row + 1 < rows; ++row)
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
            add(at(column, row), at(column + 1, row), at(column + 1, row + 1));
            add(at(column, row), at(column + 1, row + 1), at(column, row + 1));
        }
    // The border, counter-clockwise seen from above.
    std::vector<std::uint32_t> border;
    for (std::uint32_t k = 0; k + 1 < columns; ++k) border.push_back(at(k, 0));
    for (std::uint32_t k = 0; k + 1 < rows; ++k) border.push_back(at(columns - 1, k));
    for (std::uint32_t k = columns - 1; k > 0; --k) border.push_back(at(k, rows - 1));
    for (std::uint32_t k = rows - 1; k > 0; --k) border.push_back(at(0, k));
    const auto count = static_cast<std::uint32_t>(border.size());
    const auto low = static_cast<std::uint32_t>(ground.vertices.size());
    for (const std::uint32_t top : border) {
        glm::dvec3 place = ground.vertices[top];
        place.z = bottom;
        ground.vertices.push_back(place);
    }
    ground.vertices.emplace_back(0.5 * (box.min.x + box.max.x), 0.5 * (box.min.y + box.max.y), bottom);
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t next = (k + 1) % count;
        add(border[k], low + k, low + next);
        add(border[k], low + next, border[next]);
        add(low + count, low + next, low + k);
    }
    return ground;
}

}  // namespace spherule::scene
