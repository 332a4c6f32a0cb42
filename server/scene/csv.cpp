#include <spdlog/fmt/fmt.h>

#include <optional>
#include <string_view>

#include "scene/source.h"
#include "scene/sphere_rows.h"
#include "scene/table_reader.h"

namespace spherule::scene {

namespace {

std::optional<SphereColumns> columnsOf(std::string_view header) {
    for (const bool velocity : {false, true}) {
        for (const bool radius : {false, true}) {
            if (header != fmt::format("x,y,z{}{}", velocity ? ",vx,vy,vz" : "", radius ? ",radius" : "")) continue;
            SphereColumns columns(SphereColumns::Separator::Comma, "numbers, as the header has names");
            columns.addVector(Quantity::X);
            if (velocity) columns.addVector(Quantity::Vx);
            if (radius) columns.add(Quantity::Radius);
            return columns;
        }
    }
    return std::nullopt;
}

}  // namespace

std::vector<Sphere> fromCsv(Check& check, const v1::Csv& csv, const std::filesystem::path& directory, SourceInput input,
                            FileLines& lines) {
    TableReader reader(check, at(input.field, "file"), directory / csv.file());
    const auto columns = reader.nextLine() ? columnsOf(reader.text()) : std::nullopt;
    if (!columns) {  // if the line could not be read, check keeps that earlier error
        reader.refuse(1, fmt::format("the header is {}, must be x,y,z[,vx,vy,vz][,radius]", shown(reader.text())));
        return {};
    }
    SphereRows rows(check, input, *columns);
    while (reader.nextLine() && rows.add(reader)) {
    }
    return rows.take(lines);
}

}  // namespace spherule::scene
