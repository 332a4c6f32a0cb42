// OBJ: vertices and faces. Polygons are cut into triangles.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>

#include "scene/mesh/triangles.h"

namespace spherule::scene {

namespace {

constexpr std::size_t mostCorners = 1000;  // of a polygon

// Statements that say nothing of the shape, and lines and points, which spheres do not meet.
constexpr std::array ignored = {"vt",     "vn",       "vp",       "g",          "o",        "s", "mg",
                                "usemtl", "mtllib",   "usemap",   "maplib",     "l",        "p", "bevel",
                                "lod",    "c_interp", "d_interp", "shadow_obj", "trace_obj"};

// Cuts polygons into triangles, ear by ear.
class Ears {
  public:
    Ears(const std::vector<glm::dvec3>& vertices, std::vector<std::uint32_t> polygon)
        : vertices_(vertices), polygon_(std::move(polygon)) {
        for (std::size_t k = 0; k < polygon_.size(); ++k) normal_ += glm::cross(at(k) - at(0), at(k + 1) - at(0));
    }

    // Returns false once fewer than three corners are left.
    bool next(std::array<std::uint32_t, 3>& ear) {
        const std::size_t count = polygon_.size();
        if (count < 3) return false;
        std::size_t k = 0;
        while (k < count && !isEar(k)) ++k;
        if (k == count) k = 0;  // it crosses itself: any cut is as good
        ear = {polygon_[(k + count - 1) % count], polygon_[k], polygon_[(k + 1) % count]};
        polygon_.erase(polygon_.begin() + static_cast<std::ptrdiff_t>(k));
        return true;
    }

  private:
    [[nodiscard]] const glm::dvec3& at(std::size_t k) const { return vertices_[polygon_[k % polygon_.size()]]; }

    [[nodiscard]] double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
        return glm::dot(glm::cross(b - a, c - a), normal_);
    }

    [[nodiscard]] bool isEar(std::size_t k) const {
        const std::size_t count = polygon_.size();
        if (count == 3) return true;
        const glm::dvec3& a = at(k + count - 1);
        const glm::dvec3& b = at(k);
        const glm::dvec3& c = at(k + 1);
        if (!(turn(a, b, c) > 0)) return false;
        for (std::size_t other = k + 2; other < k + count - 1; ++other) {
            const glm::dvec3& p = at(other);
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    const std::vector<glm::dvec3>& vertices_;
    std::vector<std::uint32_t> polygon_;
    glm::dvec3 normal_{};  // of the polygon, of any length
};

class Obj {
  public:
    Obj(Check& check, const MeshBytes& from) : check_(check), from_(from), words_(from.bytes) {}

    Triangles read() {
        while (check_.ok() && words_.nextLine()) {
            const std::string_view keyword = words_.next();
            if (keyword.empty() || keyword.starts_with('#')) continue;
            if (keyword == "v")
                readVertex();
            else if (keyword == "f")
                readFace();
            else if (std::ranges::find(ignored, keyword) == ignored.end())
                refuse(fmt::format("is no statement of OBJ: {}; the file must be STL or OBJ", shown(keyword)));
        }
        return std::move(result_);
    }

  private:
    void refuse(std::string_view reason) {
        if (check_.ok()) from_.refuse(check_, words_.where(), reason);
    }

    void readVertex() {
        glm::dvec3 place{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto value = meshNumber(check_, from_, words_, words_.next());
            if (!value) return;
            place[axis] = *value;
        }
        if (result_.vertices.size() == 3 * mostTriangles)
            return refuse(
                fmt::format("is vertex {}, at most {} are allowed", 3 * mostTriangles + 1, 3 * mostTriangles));
        result_.vertices.push_back(place);
    }

    // Returns the number of a vertex from a corner such as 3/1/2 or -1.
    std::optional<std::uint32_t> corner(std::string_view word) {
        const std::string_view digits = word.substr(0, word.find('/'));
        const auto count = static_cast<std::int64_t>(result_.vertices.size());
        std::int64_t value = 0;
        const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        const bool read = error == std::errc() && rest == digits.data() + digits.size();
        const std::int64_t number = value < 0 ? count + value : value - 1;
        if (read && number >= 0 && number < count) return static_cast<std::uint32_t>(number);
        refuse(fmt::format("a corner is {}, must be the number of one of the {} vertices above", shown(word), count));
        return std::nullopt;
    }

    void readFace() {
        std::vector<std::uint32_t> polygon;
        for (std::string_view word = words_.next(); !word.empty() && word[0] != '#'; word = words_.next()) {
            const auto number = corner(word);
            if (!number) return;
            polygon.push_back(*number);
            if (polygon.size() > mostCorners)
                return refuse(fmt::format("the face has more than {} corners", mostCorners));
        }
        if (polygon.size() < 3) return refuse(fmt::format("the face has {} corners, must have three", polygon.size()));
        std::array<std::uint32_t, 3> triangle{};
        Ears ears(result_.vertices, std::move(polygon));
        while (ears.next(triangle))
            if (!addTriangle(check_, from_, result_, triangle, words_.place())) return;
    }

    Check& check_;
    const MeshBytes& from_;
    MeshWords words_;
    Triangles result_;
};

}  // namespace

Triangles readObj(Check& check, const MeshBytes& from) {
    return Obj(check, from).read();
}

}  // namespace spherule::scene
