#include "scene/sphere_rows.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace spherule::scene {

namespace {

constexpr std::array<std::string_view, 13> names{
    "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz", "radius", "half the diameter", "id", ""};

Quantity after(Quantity first, int steps) {
    return static_cast<Quantity>(static_cast<int>(first) + steps);
}

}  // namespace

void SphereColumns::add(Quantity quantity, double factor, double offset) {
    has_[static_cast<std::size_t>(quantity)] = true;
    if (quantity == Quantity::Diameter) {
        has_[static_cast<std::size_t>(Quantity::Radius)] = true;
        factor /= 2;
    }
    columns_.push_back({quantity, factor, offset});
}

void SphereColumns::addVector(Quantity first, double factor) {
    for (int axis = 0; axis < 3; ++axis) add(after(first, axis), factor);
}

std::optional<SphereRow> SphereRow::read(TableReader& reader, const SphereColumns& columns) {
    const bool commas = columns.separator_ == SphereColumns::Separator::Comma;
    const std::vector<std::string_view> cells = commas ? reader.cells() : reader.words();
    const std::size_t count = columns.columns_.size();
    if (cells.size() != count) {
        const std::string reason = fmt::format("the line must have {} {}", count, columns.rule_);
        if (cells.size() > count)
            reader.refuse(cells[count], reason);
        else
            reader.refuse(reader.text().size() + 1, reason);
        return std::nullopt;
    }
    SphereRow row;
    for (std::size_t i = 0; i < count; ++i)
        if (!row.readCell(reader, cells[i], columns.columns_[i])) return std::nullopt;
    return row;
}

bool SphereRow::readCell(TableReader& reader, std::string_view word, const SphereColumns::Column& column) {
    if (column.quantity == Quantity::Ignored) return true;
    const std::string_view name = names.at(static_cast<std::size_t>(column.quantity));
    if (column.quantity == Quantity::Id) {
        const auto id = reader.whole(word, name);
        id_ = id.value_or(0);
        return id.has_value();
    }
    const auto number = reader.number(word, name);
    if (!number) return false;
    const double value = column.offset + column.factor * *number;
    const bool isRadius = column.quantity == Quantity::Radius || column.quantity == Quantity::Diameter;
    Check limits;
    values_.at(static_cast<std::size_t>(isRadius ? Quantity::Radius : column.quantity)) =
        isRadius ? readRadius(limits, value, "") : limits.within(value, -largestComponent, largestComponent, "");
    if (!limits.ok()) reader.refuse(word, fmt::format("{} {}", name, limits.error().value().message));
    return limits.ok();
}

glm::dvec3 SphereRow::vector(Quantity first) const {
    return {of(first), of(after(first, 1)), of(after(first, 2))};
}

SphereRows::SphereRows(Check& check, SourceInput& input, const SphereColumns& columns)
    : check_(check), input_(input), columns_(columns), field_(at(input.field, "file")) {
    if (!columns_.has(Quantity::Radius)) (void)requiredRadii(check, input);
}

void SphereRows::expect(std::uint64_t count) {
    (void)checkRoom(check_, input_, static_cast<double>(count), field_, bytesBesides());
}

std::size_t SphereRows::bytesBesides() const {
    const std::size_t idAndOrder = sizeof(std::uint64_t) + sizeof(std::uint32_t);
    return sizeof(std::uint32_t) + (columns_.has(Quantity::Id) ? idAndOrder : 0);
}

bool SphereRows::makeRoom() {
    constexpr std::size_t first = 1024;
    const std::size_t now = spheres_.size();
    if (now < spheres_.capacity()) return true;
    const std::size_t next = std::max(now + 1, std::min(std::max(first, 2 * now), input_.room));
    const auto room = checkRoom(check_, input_, static_cast<double>(next), field_, bytesBesides());
    if (!room) return false;
    spheres_.reserve(next);
    lines_.reserve(next);
    if (columns_.has(Quantity::Id)) ids_.reserve(next);
    return true;
}

bool SphereRows::add(TableReader& reader) {
    const auto row = SphereRow::read(reader, columns_);
    if (!row || !check_.ok() || !makeRoom()) return false;
    Sphere sphere{.position = row->vector(Quantity::X), .velocity = input_.velocity, .spin = input_.spin};
    if (columns_.has(Quantity::Vx)) sphere.velocity = row->vector(Quantity::Vx);
    if (columns_.has(Quantity::Wx)) sphere.spin = row->vector(Quantity::Wx);
    if (columns_.has(Quantity::Radius)) sphere.radius = static_cast<float>(row->of(Quantity::Radius));
    spheres_.push_back(sphere);
    lines_.push_back(static_cast<std::uint32_t>(reader.line()));
    if (columns_.has(Quantity::Id)) ids_.push_back(row->id());
    return true;
}

void SphereRows::sortById(TableReader& reader) {
    std::vector<std::uint32_t> from(size());
    std::iota(from.begin(), from.end(), 0U);
    std::ranges::stable_sort(from, {}, [&](std::uint32_t number) { return ids_[number]; });
    const auto same = std::ranges::adjacent_find(from, {}, [&](std::uint32_t number) { return ids_[number]; });
    if (same != from.end())
        return reader.refuseLine(lines_[*(same + 1)], fmt::format("the id {} is also in line {}; each sphere must have "
                                                                  "one of its own",
                                                                  ids_[*same], lines_[*same]));
    // Follows each cycle of the permutation.
    for (std::uint32_t first = 0; first < from.size(); ++first) {
        const auto kept = std::tuple(spheres_[first], lines_[first], ids_[first]);
        std::uint32_t place = first;
        while (from[place] != first) {
            const std::uint32_t source = std::exchange(from[place], place);
            std::tie(spheres_[place], lines_[place], ids_[place]) =
                std::tie(spheres_[source], lines_[source], ids_[source]);
            place = source;
        }
        from[place] = place;
        std::tie(spheres_[place], lines_[place], ids_[place]) = kept;
    }
}

std::optional<std::size_t> SphereRows::withId(std::uint64_t id) const {
    const auto found = std::ranges::lower_bound(ids_, id);
    if (found == ids_.end() || *found != id) return std::nullopt;
    return static_cast<std::size_t>(found - ids_.begin());
}

std::vector<Sphere> SphereRows::take(FileLines& lines) {
    if (!check_.ok()) return {};
    if (!columns_.has(Quantity::Radius)) {
        const RadiusDistribution& radii = requiredRadii(check_, input_);
        for (Sphere& sphere : spheres_) sphere.radius = radii.draw(input_.random);
    }
    lines = std::move(lines_);
    return std::move(spheres_);
}

double readFileScale(Check& check, double scale, const SourceInput& input) {
    return scale == 0 ? 1 : check.upTo(scale, 1e9, at(input.field, "scale"), " m per unit");
}

}  // namespace spherule::scene
