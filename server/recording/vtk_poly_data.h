#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

namespace spherule::recording {

// Makes a file of VTK's format PolyData, with raw appended arrays.
class VtkPolyData {
  public:
    struct Counts {
        std::size_t points = 0;
        std::size_t vertices = 0;
        std::size_t polygons = 0;
    };

    // `fields`: the elements of the field data.
    VtkPolyData(const Counts& counts, const std::string& fields);

    // Begins an element, such as PointData, to which the next arrays belong.
    void begin(std::string_view element, std::string_view attributes = "");
    void array(std::string_view name, std::span<const float> values) { add("Float32", name, 1, values); }
    void array(std::string_view name, std::span<const std::int32_t> values) { add("Int32", name, 1, values); }
    void array(std::string_view name, std::span<const glm::dvec3> values) { add("Float64", name, 3, values); }
    // Returns the content of the file. Call once.
    std::string finish();

  private:
    template <class T>
    void add(std::string_view type, std::string_view name, int components, std::span<const T> values);
    void end();

    std::string text_;
    std::string data_;     // of the arrays
    std::string element_;  // that has begun
};

}  // namespace spherule::recording
