#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "core/input_file.h"
#include "scene/source.h"

namespace spherule::scene {

namespace {

using Row = std::array<double, 7>;

constexpr std::size_t longestLine = 4096;  // bytes

struct Columns {
    bool velocity = false;
    bool radius = false;

    [[nodiscard]] std::vector<std::string_view> names() const {
        std::vector<std::string_view> result{"x", "y", "z"};
        if (velocity) result.insert(result.end(), {"vx", "vy", "vz"});
        if (radius) result.emplace_back("radius");
        return result;
    }
};

std::optional<Columns> columnsOf(std::string_view header) {
    for (const bool velocity : {false, true}) {
        for (const bool radius : {false, true}) {
            const Columns columns{velocity, radius};
            if (header == fmt::format("{}", fmt::join(columns.names(), ","))) return columns;
        }
    }
    return std::nullopt;
}

// Reads the lines of a file. Its errors contain the path, the line and the column.
class CsvReader {
  public:
    CsvReader(Check& check, std::string field, std::filesystem::path path)
        : check_(check), field_(std::move(field)), path_(std::move(path)) {}

    bool open() {
        auto file = InputFile::open(path_.string());
        if (file)
            lines_.emplace(std::move(*file));
        else
            check_.refuse(field_, file.error().text());
        return file.has_value();
    }

    // Returns false at the end of the file. Also returns false, and refuses, if the line cannot be read.
    bool nextLine() {
        const auto more = lines_->next(longestLine);
        if (!more) check_.refuse(field_, fmt::format("{}:{}: {}", path_.string(), line(), more.error().message));
        return more.value_or(false);
    }

    [[nodiscard]] const std::string& text() const { return lines_->line(); }

    void refuse(std::size_t column, std::string_view reason) {
        check_.refuse(field_, fmt::format("{}:{}:{}: {}", path_.string(), line(), column, reason));
    }

    // Returns the numbers of the line, one for each name; nullopt if the line is refused.
    std::optional<Row> row(const std::vector<std::string_view>& names) {
        Row result{};
        const std::string& text = lines_->line();
        std::size_t start = 0;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const std::size_t comma = std::min(text.find(',', start), text.size());
            if ((comma == text.size()) != (i + 1 == names.size())) {
                refuse(comma + 1, fmt::format("the line must have {} numbers, as the header has names", names.size()));
                return std::nullopt;
            }
            if (!number(text, start, comma, names[i], result[i])) return std::nullopt;
            start = comma + 1;
        }
        return result;
    }

  private:
    [[nodiscard]] std::size_t line() const { return lines_->number(); }

    bool number(std::string_view text, std::size_t start, std::size_t end, std::string_view name, double& value) {
        while (start < end && text[start] == ' ') ++start;
        while (end > start && text[end - 1] == ' ') --end;
        const std::string_view digits = text.substr(start, end - start);
        const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        Check limits;
        if (error != std::errc() || rest != digits.data() + digits.size()) {
            limits.refuse("", fmt::format("is {}, must be a number", shown(digits)));
        } else if (name == "radius") {
            readRadius(limits, value, "");
        } else {
            limits.within(value, -largestComponent, largestComponent, "");
        }
        if (!limits.ok()) refuse(start + 1, fmt::format("{} {}", name, limits.error().value().message));
        return limits.ok();
    }

    Check& check_;
    std::string field_;
    std::filesystem::path path_;
    std::optional<LineReader> lines_;
};

}  // namespace

namespace {

// Makes room for one more sphere. The number of spheres is not known before the end of the file.
bool makeRoom(Check& check, const SourceInput& input, std::vector<Sphere>& spheres, const std::string& field) {
    constexpr std::size_t first = 1024;
    if (spheres.size() < spheres.capacity()) return true;
    const std::size_t next = std::max(spheres.size() + 1, std::min(std::max(first, 2 * spheres.size()), input.room));
    const auto room = checkRoom(check, input, static_cast<double>(next), field);
    if (room) spheres.reserve(next);
    return room.has_value();
}

}  // namespace

std::vector<Sphere> fromCsv(Check& check, const v1::Csv& csv, const std::filesystem::path& directory,
                            SourceInput input) {
    const std::string field = at(input.field, "file");
    CsvReader reader(check, field, directory / csv.file());
    if (!reader.open()) return {};
    const auto columns = reader.nextLine() ? columnsOf(reader.text()) : std::nullopt;
    if (!columns) {  // if the line could not be read, check keeps that earlier error
        reader.refuse(1, fmt::format("the header is {}, must be x,y,z[,vx,vy,vz][,radius]", shown(reader.text())));
        return {};
    }
    const std::vector<std::string_view> names = columns->names();
    const RadiusDistribution radii = columns->radius ? RadiusDistribution{} : requiredRadii(check, input);
    std::vector<Sphere> spheres;
    while (check.ok() && reader.nextLine()) {
        const auto row = reader.row(names);
        if (!row || !makeRoom(check, input, spheres, field)) break;
        const Row& v = *row;
        Sphere sphere{.position = {v[0], v[1], v[2]}, .velocity = input.velocity, .spin = input.spin};
        if (columns->velocity) sphere.velocity = glm::dvec3(v[3], v[4], v[5]);
        sphere.radius = columns->radius ? static_cast<float>(v[names.size() - 1]) : radii.draw(input.random);
        spheres.push_back(sphere);
    }
    return spheres;
}

}  // namespace spherule::scene
