#include "scene/lammps_dump.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "scene/sphere_rows.h"

namespace spherule::scene {

namespace {

using Words = std::vector<std::string_view>;

bool has(const Words& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

// The box of a snapshot, in units of the file.
struct DumpBox {
    bool orthogonal = false;
    glm::dvec3 low{};
    glm::dvec3 size{};
};

// Names of three columns.
struct Vector {
    std::array<std::string_view, 3> names;
    Quantity first = Quantity::Ignored;
    bool length = false;  // in the file's unit
    bool scaled = false;  // relative to the box
};

// The first vector of positions that a dump has is read.
constexpr std::array<Vector, 6> vectors{{{{"x", "y", "z"}, Quantity::X, true},
                                         {{"xu", "yu", "zu"}, Quantity::X, true},
                                         {{"xs", "ys", "zs"}, Quantity::X, true, true},
                                         {{"xsu", "ysu", "zsu"}, Quantity::X, true, true},
                                         {{"vx", "vy", "vz"}, Quantity::Vx, true},
                                         {{"omegax", "omegay", "omegaz"}, Quantity::Wx, false}}};

class Snapshot {
  public:
    Snapshot(Check& check, TableReader& reader, const DumpOptions& options, SourceInput& input)
        : check_(check), reader_(reader), options_(options), input_(input) {}

    // Moves to the line ITEM: ATOMS of the wanted snapshot.
    bool moveToAtoms() {
        for (std::uint32_t number = 0; check_.ok();) {
            const std::string_view line = reader_.text();
            if (line.starts_with("ITEM: NUMBER OF ATOMS")) {
                readCount();
            } else if (line.starts_with("ITEM: BOX BOUNDS")) {
                readBox();
            } else if (line.starts_with("ITEM: ATOMS")) {
                if (!count_) reader_.refuse(1, "the number of atoms must come before ITEM: ATOMS");
                if (number == options_.frame) break;
                ++number;
                for (std::uint64_t i = 0; i < count_.value_or(0) && nextRow(i); ++i) {
                }
                count_.reset();
            }
            if (check_.ok() && !reader_.nextLine())
                reader_.refuse(1, fmt::format("the file ends before snapshot {}; the first is 0", options_.frame));
        }
        return check_.ok();
    }

    std::vector<Sphere> spheres(FileLines& lines) {
        const SphereColumns columns = readColumns();
        SphereRows rows(check_, input_, columns);
        rows.expect(*count_);
        while (check_.ok() && rows.size() < *count_)
            if (!nextRow(rows.size()) || !rows.add(reader_)) break;
        if (check_.ok()) rows.sortById(reader_);
        return rows.take(lines);
    }

  private:
    bool nextRow(std::uint64_t index) {
        if (reader_.nextLine()) return true;
        reader_.refuse(1, fmt::format("the file ends after {} of {} atoms", index, *count_));
        return false;
    }

    void readCount() {
        const auto words = reader_.nextLine() ? reader_.words() : Words();
        count_ = words.size() == 1 ? reader_.whole(words[0], "the number of atoms") : std::nullopt;
        if (!count_) reader_.refuse(1, "the line must have the number of atoms");
    }

    void readBox() {
        box_ = {.orthogonal = true};
        for (int axis = 0; axis < 3; ++axis) {
            const auto words = reader_.nextLine() ? reader_.words() : Words();
            if (words.size() < 2) return reader_.refuse(1, "the line must have the limits of the box on an axis");
            if (words.size() > 2) box_.orthogonal = false;
            const auto low = reader_.number(words[0], "the lower limit");
            const auto high = low ? reader_.number(words[1], "the upper limit") : std::nullopt;
            if (!high) return;
            box_.low[axis] = *low;
            box_.size[axis] = *high - *low;
        }
    }

    // Reads the columns from the line ITEM: ATOMS.
    SphereColumns readColumns() {
        Words names = reader_.words();
        names.erase(names.begin(), names.begin() + 2);
        SphereColumns columns(SphereColumns::Separator::Blanks, "values, as ITEM: ATOMS has columns");
        const std::vector<const Vector*> present = vectorsIn(names);
        const bool radius = has(names, "radius");
        for (const std::string_view name : names) {
            if (name == "id" && !columns.has(Quantity::Id))
                columns.add(Quantity::Id);
            else if (name == "radius" && !columns.has(Quantity::Radius))
                columns.add(Quantity::Radius, options_.scale);
            else if (name == "diameter" && !radius && !columns.has(Quantity::Radius))
                columns.add(Quantity::Diameter, options_.scale);
            else
                addComponent(columns, name, present);
        }
        if (!columns.has(Quantity::Id))
            reader_.refuse(1, "the dump has no column id, which gives the order of the spheres; add id to its columns");
        if (!columns.has(Quantity::X))
            reader_.refuse(1,
                           "the dump has no positions; it must have the columns x y z, xu yu zu, xs ys zs or xsu ysu "
                           "zsu");
        return columns;
    }

    // Returns the vectors to read. Refuses those without all components.
    std::vector<const Vector*> vectorsIn(const Words& names) {
        std::vector<const Vector*> result;
        for (const Vector& vector : vectors) {
            const auto absent =
                std::ranges::find_if(vector.names, [&](std::string_view name) { return !has(names, name); });
            const auto there =
                std::ranges::find_if(vector.names, [&](std::string_view name) { return has(names, name); });
            if (there == vector.names.end()) continue;
            if (absent != vector.names.end()) {
                reader_.refuse(1, fmt::format("the dump has the column {}, but not {}", *there, *absent));
                continue;
            }
            if (std::ranges::any_of(result, [&](const Vector* one) { return one->first == vector.first; })) continue;
            if (vector.scaled && !box_.orthogonal)
                reader_.refuse(1,
                               fmt::format("{} is relative to the box, which must be orthogonal then; write x y z in "
                                           "its place",
                                           vector.names[0]));
            result.push_back(&vector);
        }
        return result;
    }

    void addComponent(SphereColumns& columns, std::string_view name, const std::vector<const Vector*>& present) const {
        for (const Vector* vector : present) {
            const auto* const found = std::ranges::find(vector->names, name);
            if (found == vector->names.end()) continue;
            const auto axis = static_cast<int>(found - vector->names.begin());
            const auto quantity = static_cast<Quantity>(static_cast<int>(vector->first) + axis);
            if (columns.has(quantity)) break;
            const double unit = vector->length ? options_.scale : 1;
            if (vector->scaled) return columns.add(quantity, unit * box_.size[axis], unit * box_.low[axis]);
            return columns.add(quantity, unit);
        }
        columns.add(Quantity::Ignored);
    }

    Check& check_;
    TableReader& reader_;
    const DumpOptions& options_;
    SourceInput& input_;
    std::optional<std::uint64_t> count_;
    DumpBox box_;
};

}  // namespace

std::vector<Sphere> fromLammpsDump(Check& check, TableReader& reader, const DumpOptions& options, SourceInput& input,
                                   FileLines& lines) {
    Snapshot snapshot(check, reader, options, input);
    return snapshot.moveToAtoms() ? snapshot.spheres(lines) : std::vector<Sphere>();
}

}  // namespace spherule::scene
