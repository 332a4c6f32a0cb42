#include "scene/lammps_data.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>

#include "scene/sphere_rows.h"

namespace spherule::scene {

namespace {

constexpr std::size_t imageFlags = 3;  // columns that may follow the position

// A section begins with its name: words that begin with a capital letter.
bool isSection(std::string_view line) {
    return !line.empty() && std::isupper(static_cast<unsigned char>(line.front())) != 0;
}

// Returns the text after the first # of a line without blanks around it; empty if there is none.
std::string_view commentIn(std::string_view line) {
    constexpr std::string_view blanks = " \t";
    line.remove_prefix(std::min(line.find('#'), line.size()));
    const std::size_t first = line.find_first_not_of(blanks, 1);
    if (first == std::string_view::npos) return {};
    return line.substr(first, line.find_last_not_of(blanks) + 1 - first);
}

// The atom style follows the name of the section Atoms, as a comment.
std::optional<std::string> styleIn(TableReader& reader) {
    const std::string_view style = commentIn(reader.text());
    if (style == "sphere" || style == "atomic") return std::string(style);
    if (style.empty())
        reader.refuse(1,
                      "the section Atoms does not name its atom style; write \"Atoms # sphere\" or \"Atoms # "
                      "atomic\"");
    else
        reader.refuse(style, fmt::format("the atom style is {}, must be sphere or atomic; write the data file with "
                                         "one of them",
                                         shown(style)));
    return std::nullopt;
}

SphereColumns atomColumns(std::string_view style, double scale, bool images) {
    const bool sphere = style == "sphere";
    SphereColumns columns(SphereColumns::Separator::Blanks,
                          sphere ? "values: id type diameter density x y z, perhaps with image flags"
                                 : "values: id type x y z, perhaps with image flags");
    columns.add(Quantity::Id);
    columns.add(Quantity::Ignored);
    if (sphere) {
        columns.add(Quantity::Diameter, scale);
        columns.add(Quantity::Ignored);
    }
    columns.addVector(Quantity::X, scale);
    for (std::size_t i = 0; images && i < imageFlags; ++i) columns.add(Quantity::Ignored);
    return columns;
}

class DataFile {
  public:
    DataFile(Check& check, TableReader& reader, double scale, SourceInput& input)
        : check_(check), reader_(reader), scale_(scale), input_(input) {}

    std::vector<Sphere> spheres(FileLines& lines) {
        while (reader_.nextLine()) {
            const auto words = reader_.words();
            if (words.size() >= 2 && words[1] == "atoms" && !rows_) {
                atoms_ = reader_.whole(words[0], "the number of atoms");
            } else if (isSection(reader_.text()) && words[0] == "Atoms") {
                readAtoms();
            } else if (isSection(reader_.text()) && words[0] == "Velocities") {
                readVelocities();
            }
        }
        if (!rows_) reader_.refuse(1, "the file has no section Atoms, as a LAMMPS data file has");
        return check_.ok() ? rows_->take(lines) : std::vector<Sphere>();
    }

  private:
    // Moves to the next line, without its comment.
    bool nextLine() {
        const bool more = reader_.nextLine();
        reader_.cutAt('#');
        return more;
    }

    // Moves to row `index` of a section; the first one comes after blank lines. Refuses the end of the file.
    bool nextRow(std::uint64_t index, std::string_view section) {
        bool more = nextLine();
        while (more && index == 0 && reader_.words().empty()) more = nextLine();
        if (!more)
            reader_.refuse(
                1, fmt::format("the file ends after {} of {} lines of the section {}", index, *atoms_, section));
        return more;
    }

    void readAtoms() {
        if (rows_) return reader_.refuse(1, "the file has a second section Atoms");
        if (!atoms_) return reader_.refuse(1, "the number of atoms must come before the section Atoms");
        const auto style = styleIn(reader_);
        if (!style) return;
        columns_ = atomColumns(*style, scale_, false);
        for (std::uint64_t i = 0; i < *atoms_; ++i) {
            if (!nextRow(i, "Atoms")) return;
            if (i == 0) {
                const std::size_t without = *style == "sphere" ? 7 : 5;
                columns_ = atomColumns(*style, scale_, reader_.words().size() == without + imageFlags);
                rows_.emplace(check_, input_, columns_);
                rows_->expect(*atoms_);
            }
            if (!rows_->add(reader_)) return;
        }
        if (!rows_) rows_.emplace(check_, input_, columns_);
        spinning_ = *style == "sphere";
        rows_->sortById(reader_);
    }

    void readVelocities() {
        if (!rows_) return reader_.refuse(1, "the section Velocities must come after the section Atoms");
        SphereColumns columns(SphereColumns::Separator::Blanks,
                              spinning_ ? "values: id vx vy vz wx wy wz" : "values: id vx vy vz");
        columns.add(Quantity::Id);
        columns.addVector(Quantity::Vx, scale_);
        if (spinning_) columns.addVector(Quantity::Wx);
        std::vector<bool> seen(rows_->size());
        for (std::uint64_t i = 0; i < *atoms_; ++i) {
            if (!nextRow(i, "Velocities")) return;
            const auto row = SphereRow::read(reader_, columns);
            if (!row) return;
            const auto number = rows_->withId(row->id());
            if (!number || seen[*number])
                return reader_.refuse(1, fmt::format("the id {} {}", row->id(),
                                                     number ? "is in an earlier line of the section, too"
                                                            : "is not in the section Atoms"));
            seen[*number] = true;
            (*rows_)[*number].velocity = row->vector(Quantity::Vx);
            if (spinning_) (*rows_)[*number].spin = row->vector(Quantity::Wx);
        }
    }

    Check& check_;
    TableReader& reader_;
    double scale_;
    SourceInput& input_;
    std::optional<std::uint64_t> atoms_;  // as the header promises
    SphereColumns columns_ = atomColumns("atomic", 1, false);
    std::optional<SphereRows> rows_;
    bool spinning_ = false;
};

}  // namespace

std::vector<Sphere> fromLammpsData(Check& check, TableReader& reader, double scale, SourceInput& input,
                                   FileLines& lines) {
    return DataFile(check, reader, scale, input).spheres(lines);
}

}  // namespace spherule::scene
