#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/source.h"
#include "scene/table_reader.h"

namespace spherule::scene {

// A quantity in a column of a file. The components of a vector follow each other.
enum class Quantity : std::uint8_t { X, Y, Z, Vx, Vy, Vz, Wx, Wy, Wz, Radius, Diameter, Id, Ignored };

// The columns of a table of spheres.
class SphereColumns {
  public:
    enum class Separator : std::uint8_t { Comma, Blanks };

    // `rule` ends the refusal of a line with another number of columns: "numbers, as the header has names".
    SphereColumns(Separator separator, std::string rule) : separator_(separator), rule_(std::move(rule)) {}

    // Adds a column: a number n in the file is `offset` + `factor` n in SI units.
    void add(Quantity quantity, double factor = 1, double offset = 0);
    // Adds columns for the three components of the vector.
    void addVector(Quantity first, double factor = 1);
    [[nodiscard]] bool has(Quantity quantity) const { return has_[static_cast<std::size_t>(quantity)]; }

  private:
    friend class SphereRow;

    struct Column {
        Quantity quantity;
        double factor;
        double offset;
    };

    Separator separator_;
    std::string rule_;
    std::vector<Column> columns_;
    std::array<bool, static_cast<std::size_t>(Quantity::Ignored) + 1> has_{};
};

// The quantities in a line, in SI units.
class SphereRow {
  public:
    // Refuses a line with another number of columns, and quantities that no sphere may have.
    static std::optional<SphereRow> read(TableReader& reader, const SphereColumns& columns);

    [[nodiscard]] double of(Quantity quantity) const { return values_[static_cast<std::size_t>(quantity)]; }
    [[nodiscard]] glm::dvec3 vector(Quantity first) const;
    [[nodiscard]] std::uint64_t id() const { return id_; }

  private:
    bool readCell(TableReader& reader, std::string_view word, const SphereColumns::Column& column);

    std::array<double, static_cast<std::size_t>(Quantity::Id)> values_{};
    std::uint64_t id_ = 0;
};

// Collects the spheres of a file. Allocates memory as they come, because a file may promise more than it has.
class SphereRows {
  public:
    // Refuses if neither the columns nor the group gives radii. Both arguments must outlive the rows.
    SphereRows(Check& check, SourceInput& input, const SphereColumns& columns);

    // Refuses at once a number of spheres for which the scene has no room.
    void expect(std::uint64_t count);

    // Adds the sphere in the reader's line. Returns false if it is refused.
    bool add(TableReader& reader);
    [[nodiscard]] std::size_t size() const { return spheres_.size(); }

    // Puts the spheres in the order of their IDs. Refuses two spheres with the same ID. `reader` must still be open.
    void sortById(TableReader& reader);
    // Returns the number of the sphere with this ID; sortById() must have put them in order.
    [[nodiscard]] std::optional<std::size_t> withId(std::uint64_t id) const;
    [[nodiscard]] Sphere& operator[](std::size_t number) { return spheres_[number]; }

    // Draws the radii that the file does not give, in order. Returns the spheres; empty if anything was refused.
    std::vector<Sphere> take(FileLines& lines);

  private:
    bool makeRoom();
    [[nodiscard]] std::size_t bytesBesides() const;

    Check& check_;
    SourceInput& input_;
    const SphereColumns& columns_;
    std::string field_;
    std::vector<Sphere> spheres_;
    FileLines lines_;
    std::vector<std::uint64_t> ids_;
};

// Reads the field `scale` of a source: m per unit of length of the file. 0, or absent: 1.
double readFileScale(Check& check, double scale, const SourceInput& input);

}  // namespace spherule::scene
