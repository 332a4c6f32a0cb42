// STL, binary and as text. Normals in the file are ignored: the order of the corners gives them.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <spdlog/fmt/fmt.h>

#include "scene/mesh/triangles.h"

namespace spherule::scene {

namespace {

constexpr std::size_t headerBytes = 80;
constexpr std::size_t countBytes = 4;
constexpr std::size_t triangleBytes = 50;  // normal, three corners, two bytes of attributes
constexpr std::size_t normalBytes = 12;

std::uint32_t wordAt(std::string_view bytes, std::size_t place) {
    unsigned char raw[4];
    std::memcpy(raw, bytes.data() + place, sizeof raw);
    return raw[0] | static_cast<std::uint32_t>(raw[1]) << 8U | static_cast<std::uint32_t>(raw[2]) << 16U |
           static_cast<std::uint32_t>(raw[3]) << 24U;
}

std::uint64_t lengthOf(std::string_view bytes) {
    return headerBytes + countBytes + std::uint64_t{triangleBytes} * wordAt(bytes, headerBytes);
}

std::string lower(std::string_view word) {
    std::string result(word);
    std::ranges::transform(result, result.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return result;
}

// Reads the words of a text STL. Line breaks are blanks.
class TextStl {
  public:
    TextStl(Check& check, const MeshBytes& from) : check_(check), from_(from), words_(from.bytes) {}

    Triangles read() {
        Triangles result;
        expect("solid");
        skipLine();
        while (check_.ok()) {
            const std::string word = lower(next());
            if (word == "endsolid") {
                skipLine();
                if (!moreSolids()) break;
                continue;
            }
            if (word != "facet") {
                refuse(word, "facet or endsolid");
                break;
            }
            readFacet(result);
        }
        return result;
    }

  private:
    void readFacet(Triangles& to) {
        expect("normal");
        for (int k = 0; k < 3; ++k) next();  // may be any text: some programs write nan
        expect("outer");
        expect("loop");
        const auto first = static_cast<std::uint32_t>(to.vertices.size());
        for (int k = 0; k < 3 && check_.ok(); ++k) {
            expect("vertex");
            glm::dvec3 place{};
            for (int axis = 0; axis < 3 && check_.ok(); ++axis)
                if (const auto value = meshNumber(check_, from_, words_, next())) place[axis] = *value;
            to.vertices.push_back(place);
        }
        expect("endloop");
        expect("endfacet");
        if (check_.ok()) addTriangle(check_, from_, to, {first, first + 1, first + 2}, words_.place());
    }

    std::string_view next() {
        std::string_view word = words_.next();
        while (word.empty() && words_.nextLine()) word = words_.next();
        return word;
    }

    void skipLine() {
        while (!words_.next().empty()) {
        }
    }

    bool moreSolids() {
        const std::string_view word = next();
        if (word.empty()) return false;
        if (lower(word) != "solid") refuse(word, "solid, or the end of the file");
        skipLine();
        return check_.ok();
    }

    void refuse(std::string_view word, std::string_view expected) {
        if (!check_.ok()) return;
        from_.refuse(check_, words_.where(),
                     word.empty() ? fmt::format("the file ends, must have {} here", expected)
                                  : fmt::format("is {}, must be {}", shown(word), expected));
    }

    void expect(std::string_view expected) {
        if (!check_.ok()) return;
        const std::string_view word = next();
        if (lower(word) != expected) refuse(word, expected);
    }

    Check& check_;
    const MeshBytes& from_;
    MeshWords words_;
};

}  // namespace

// The header may begin with "solid", as a text does. A text has no zero bytes, and not the length that its bytes 80 to
// 83 would give.
bool isBinaryStl(std::string_view bytes) {
    if (bytes.size() < headerBytes + countBytes) return false;
    if (lengthOf(bytes) == bytes.size()) return true;
    const std::string_view head = bytes.substr(0, std::min<std::size_t>(bytes.size(), 1024));
    return head.find('\0') != std::string_view::npos;
}

Triangles readBinaryStl(Check& check, const MeshBytes& from) {
    Triangles result;
    const std::uint32_t count = wordAt(from.bytes, headerBytes);
    if (lengthOf(from.bytes) != from.bytes.size()) {
        from.refuse(check, "",
                    fmt::format("as a binary STL of {} triangles it must have {} bytes, but it has {}; "
                                "write it again",
                                count, lengthOf(from.bytes), from.bytes.size()));
        return result;
    }
    if (count > mostTriangles) {
        from.refuse(check, "",
                    fmt::format("has {} triangles, must have at most {}; make it coarser", count, mostTriangles));
        return result;
    }
    result.vertices.reserve(3 * std::size_t{count});
    result.corners.reserve(count);
    std::size_t place = headerBytes + countBytes;
    for (std::uint32_t k = 0; k < count; ++k, place += triangleBytes) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            glm::dvec3 vertex{};
            for (int axis = 0; axis < 3; ++axis) {
                const std::size_t at = place + normalBytes + 12 * corner + 4 * static_cast<std::size_t>(axis);
                const auto value = static_cast<double>(std::bit_cast<float>(wordAt(from.bytes, at)));
                if (!(std::abs(value) <= largestMeshCoordinate)) {
                    from.refuse(check, fmt::format("triangle {} of {}", k + 1, count),
                                fmt::format("a coordinate is {:g}, must be a number of at most {:g}", value,
                                            largestMeshCoordinate));
                    return result;
                }
                vertex[axis] = value;
            }
            result.vertices.push_back(vertex);
        }
        if (!addTriangle(check, from, result, {3 * k, 3 * k + 1, 3 * k + 2}, place)) break;
    }
    return result;
}

Triangles readTextStl(Check& check, const MeshBytes& from) {
    return TextStl(check, from).read();
}

}  // namespace spherule::scene
