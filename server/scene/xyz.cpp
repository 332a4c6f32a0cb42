#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "scene/source.h"
#include "scene/sphere_rows.h"
#include "scene/table_reader.h"

namespace spherule::scene {

namespace {

constexpr std::size_t longestComment = 64U << 10U;  // bytes
constexpr std::size_t mostColumns = longestTableLine / 2;

struct Property {
    std::string_view name;
    Quantity first = Quantity::Ignored;
    std::size_t columns = 0;
    bool length = false;  // in the file's unit
};

// The names of ASE, of OVITO, and others in use.
constexpr std::array<Property, 8> known{{{"pos", Quantity::X, 3, true},
                                         {"radius", Quantity::Radius, 1, true},
                                         {"radii", Quantity::Radius, 1, true},
                                         {"velo", Quantity::Vx, 3, true},
                                         {"vel", Quantity::Vx, 3, true},
                                         {"velocities", Quantity::Vx, 3, true},
                                         {"omega", Quantity::Wx, 3, false},
                                         {"angular_velocity", Quantity::Wx, 3, false}}};

// Returns the value of Properties in a comment of key=value, where values may be in quotes; nullopt if there is none.
std::optional<std::string_view> propertiesIn(std::string_view comment) {
    constexpr std::string_view key = "Properties=";
    bool quoted = false;
    for (std::size_t i = 0; i < comment.size(); ++i) {
        if (comment[i] == '"' && (i == 0 || comment[i - 1] != '\\')) quoted = !quoted;
        const bool begins = i == 0 || comment[i - 1] == ' ' || comment[i - 1] == '\t';
        if (quoted || !begins || !comment.substr(i).starts_with(key)) continue;
        std::string_view value = comment.substr(i + key.size());
        const bool inQuotes = value.starts_with('"');
        if (inQuotes) value.remove_prefix(1);
        return value.substr(0, value.find_first_of(inQuotes ? "\"" : " \t"));
    }
    return std::nullopt;
}

// Takes the part before the next colon.
std::string_view cut(std::string_view& rest) {
    const std::string_view part = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    return part;
}

// Adds the columns of a property. Refuses one that cannot be read.
void addProperty(TableReader& reader, SphereColumns& columns, std::string_view name, std::uint64_t wide, double scale) {
    const auto* const property = std::ranges::find(known, name, &Property::name);
    if (property == known.end()) {
        for (std::uint64_t i = 0; i < wide; ++i) columns.add(Quantity::Ignored);
        return;
    }
    if (wide != property->columns)
        return reader.refuse(
            name, fmt::format("the property {} has {} columns, must have {}", name, wide, property->columns));
    if (columns.has(property->first))
        return reader.refuse(name,
                             fmt::format("the property {} gives a quantity that an earlier property gives", name));
    const double factor = property->length ? scale : 1;
    if (property->columns == 3)
        columns.addVector(property->first, factor);
    else
        columns.add(property->first, factor);
}

// Reads the columns from the comment, the reader's line. Refuses those that cannot be read.
SphereColumns readColumns(TableReader& reader, double scale) {
    const auto properties = propertiesIn(reader.text());
    SphereColumns columns(SphereColumns::Separator::Blanks,
                          properties ? "values, as Properties has columns" : "values: species x y z");
    if (!properties) {
        columns.add(Quantity::Ignored);
        columns.addVector(Quantity::X, scale);
        return columns;
    }
    std::size_t count = 0;
    for (std::string_view rest = *properties; reader.ok() && !rest.empty();) {
        const std::string_view name = cut(rest);
        const std::string_view type = cut(rest);
        const std::string_view width = cut(rest);
        if (type.empty() || width.empty()) reader.refuse(name, "Properties must be a list of name:type:columns");
        const auto wide = reader.ok() ? reader.whole(width, "the number of columns") : std::nullopt;
        if (!wide) break;
        count += *wide;
        if (*wide > mostColumns || count > mostColumns) {
            reader.refuse(width, fmt::format("Properties has too many columns, must have at most {}", mostColumns));
            break;
        }
        addProperty(reader, columns, name, *wide, scale);
    }
    if (!columns.has(Quantity::X)) reader.refuse(1, "Properties has no positions, must have pos:R:3");
    return columns;
}

// Moves to the comment of the frame. Blank lines may be between two frames. Returns its number of spheres.
std::optional<std::uint64_t> moveTo(TableReader& reader, std::uint32_t frame) {
    for (std::uint32_t number = 0;; ++number) {
        bool more = reader.nextLine();
        while (more && reader.words().empty()) more = reader.nextLine();
        if (!more) {
            reader.refuse(1, fmt::format("the file ends before frame {}; the first is 0", frame));
            return std::nullopt;
        }
        const auto words = reader.words();
        if (words.size() != 1) {
            reader.refuse(1, fmt::format("the line is {}, must be the number of atoms, as in the format XYZ",
                                         shown(reader.text())));
            return std::nullopt;
        }
        const auto count = reader.whole(words[0], "the number of atoms");
        if (!count) return std::nullopt;
        if (!reader.nextLine(longestComment)) reader.refuse(1, "the file ends before the comment line");
        if (!reader.ok()) return std::nullopt;
        if (number == frame) return count;
        for (std::uint64_t i = 0; i < *count; ++i) {
            if (reader.nextLine()) continue;
            reader.refuse(1, fmt::format("the file ends after {} of {} atoms of frame {}", i, *count, number));
            return std::nullopt;
        }
    }
}

}  // namespace

std::vector<Sphere> fromXyz(Check& check, const v1::Xyz& xyz, const std::filesystem::path& directory, SourceInput input,
                            FileLines& lines) {
    const double scale = readFileScale(check, xyz.scale(), input);
    TableReader reader(check, at(input.field, "file"), directory / xyz.file());
    const auto count = moveTo(reader, xyz.frame());
    if (!count) return {};
    const SphereColumns columns = readColumns(reader, scale);
    SphereRows rows(check, input, columns);
    rows.expect(*count);
    while (check.ok() && rows.size() < *count) {
        if (!reader.nextLine())
            reader.refuse(1, fmt::format("the file ends after {} of {} atoms", rows.size(), *count));
        if (!check.ok() || !rows.add(reader)) break;
    }
    return rows.take(lines);
}

}  // namespace spherule::scene
