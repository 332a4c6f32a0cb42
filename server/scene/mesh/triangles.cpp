#include "scene/mesh/triangles.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <spdlog/fmt/fmt.h>

#include "core/input_file.h"
#include "core/memory.h"

namespace spherule::scene {

void MeshBytes::refuse(Check& check, std::string_view place, std::string_view reason) const {
    std::string text = name;
    if (!text.empty() && !place.empty()) text += ", ";
    text += place;
    if (!text.empty()) text += ": ";
    check.refuse(field, text + std::string(reason));
}

std::optional<std::string> readMeshFile(Check& check, const std::optional<std::filesystem::path>& directory,
                                        const std::string& file, const std::string& field) {
    if (!directory) {
        check.refuse(field, fmt::format("names the file {}, but only a scene file may name files", shown(file)));
        return std::nullopt;
    }
    const std::string path = (*directory / file).string();
    const auto opened = InputFile::open(path);
    if (!opened) {
        check.refuse(field, opened.error().text());
        return std::nullopt;
    }
    const auto room = memory::Claim::make(field, fmt::format("the file {}", path), opened->size());
    if (!room) {
        check.refuse(room.error());
        return std::nullopt;
    }
    auto bytes = readFile(path, longestMeshFile);
    if (bytes) return std::move(*bytes);
    check.refuse(field, bytes.error().text());
    return std::nullopt;
}

Triangles readTriangles(Check& check, const MeshBytes& from) {
    if (isBinaryStl(from.bytes)) return readBinaryStl(check, from);
    MeshWords words(from.bytes);
    std::string_view first;
    while (first.empty() && words.nextLine()) first = words.next();
    if (first == "solid") return readTextStl(check, from);
    return readObj(check, from);
}

bool MeshWords::nextLine() {
    if (place_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', place_), text_.size());
    rest_ = text_.substr(place_, end - place_);
    place_ = end + 1;
    ++line_;
    return true;
}

std::string_view MeshWords::next() {
    constexpr std::string_view blank = " \t\r\v\f";
    const std::size_t begin = std::min(rest_.find_first_not_of(blank), rest_.size());
    const std::size_t end = std::min(rest_.find_first_of(blank, begin), rest_.size());
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
}

std::string MeshWords::where() const {
    return fmt::format("line {}", line_);
}

std::optional<double> meshNumber(Check& check, const MeshBytes& from, const MeshWords& words, std::string_view word) {
    double value = 0;
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool read = error == std::errc() && rest == digits.data() + digits.size();
    if (error == std::errc::result_out_of_range && rest == digits.data() + digits.size() && std::abs(value) < 1)
        return 0.0;
    if (read && std::abs(value) <= largestMeshCoordinate) return value;
    from.refuse(check, words.where(),
                word.empty() ? "a coordinate is missing, must be three"
                             : fmt::format("a coordinate is {}, must be a number of at most {:g}", shown(word),
                                           largestMeshCoordinate));
    return std::nullopt;
}

bool addTriangle(Check& check, const MeshBytes& from, Triangles& to, const std::array<std::uint32_t, 3>& corners,
                 std::size_t done) {
    constexpr std::size_t interval = 65536;
    if (to.corners.size() == mostTriangles) {
        from.refuse(check, "", fmt::format("has more than {} triangles; make it coarser", mostTriangles));
        return false;
    }
    if (to.corners.size() % interval == 0 && !check.goesOn("reading a mesh", done, from.bytes.size())) return false;
    to.corners.push_back(corners);
    return true;
}

}  // namespace spherule::scene
