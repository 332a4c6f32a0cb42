#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/check.h"

namespace spherule::scene {

// Triangles as a file gives them. Each names its corners counter-clockwise, seen from the side of its normal.
struct Triangles {
    std::vector<glm::dvec3> vertices{};
    std::vector<std::array<std::uint32_t, 3>> corners{};
};

constexpr std::size_t mostTriangles = 4'000'000;            // of a mesh
constexpr std::uint64_t longestMeshFile = 400ULL << 20U;    // bytes
constexpr std::size_t longestInlineMesh = 1ULL << 20U;      // bytes, in a scene itself
constexpr double largestMeshCoordinate = largestComponent;  // in units of the file

// The bytes of a file, or of a field of the scene.
struct MeshBytes {
    std::string field;       // of the scene
    std::string name;        // of the file, for errors; empty: the bytes are in the scene
    std::string_view bytes;  // must outlive the reading

    // Refuses the bytes. `place`: a line or an offset, such as "line 3"; may be empty.
    void refuse(Check& check, std::string_view place, std::string_view reason) const;
};

// Reads a whole file for MeshBytes. `file`: relative to `directory`; nullopt: the scene may not name files. Refuses and
// returns nullopt if it cannot be read.
std::optional<std::string> readMeshFile(Check& check, const std::optional<std::filesystem::path>& directory,
                                        const std::string& file, const std::string& field);

// Finds the format from the bytes, and reads them. Refuses what is not complete.
Triangles readTriangles(Check& check, const MeshBytes& from);

bool isBinaryStl(std::string_view bytes);
Triangles readBinaryStl(Check& check, const MeshBytes& from);
Triangles readTextStl(Check& check, const MeshBytes& from);
Triangles readObj(Check& check, const MeshBytes& from);

// Splits a text into lines, and lines into words. All words lie in the text.
class MeshWords {
  public:
    explicit MeshWords(std::string_view text) : text_(text) {}

    // Moves to the next line; returns false at the end of the text.
    bool nextLine();
    // Returns the next word of the line; empty at its end.
    std::string_view next();
    [[nodiscard]] std::size_t lines() const { return line_; }   // number of the line, from 1
    [[nodiscard]] std::size_t place() const { return place_; }  // bytes before the next line
    [[nodiscard]] std::string where() const;                    // "line 3"

  private:
    std::string_view text_;
    std::string_view rest_{};  // of the line
    std::size_t place_ = 0;
    std::size_t line_ = 0;
};

// Reads a finite coordinate. Refuses other words.
std::optional<double> meshNumber(Check& check, const MeshBytes& from, const MeshWords& words, std::string_view word);

// Adds a triangle. Refuses one too many, and asks every so often whether the reading goes on.
bool addTriangle(Check& check, const MeshBytes& from, Triangles& to, const std::array<std::uint32_t, 3>& corners,
                 std::size_t done);

}  // namespace spherule::scene
