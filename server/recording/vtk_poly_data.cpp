#include "recording/vtk_poly_data.h"

#include <iterator>

#include <fmt/format.h>

#include "recording/bytes.h"

namespace spherule::recording {

VtkPolyData::VtkPolyData(const Counts& counts, const std::string& fields)
    : text_(fmt::format(
          "<?xml version=\"1.0\"?>\n"
          "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
          "<FieldData>{}</FieldData>\n"
          "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
          "NumberOfPolys=\"{}\">\n",
          fields, counts.points, counts.vertices, counts.polygons)) {}

void VtkPolyData::begin(std::string_view element, std::string_view attributes) {
    end();
    element_ = element;
    fmt::format_to(std::back_inserter(text_), "<{}{}>\n", element, attributes);
}

// An array is its size in bytes, then its bytes.
template <class T>
void VtkPolyData::add(std::string_view type, std::string_view name, int components, std::span<const T> values) {
    fmt::format_to(std::back_inserter(text_),
                   "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
                   "offset=\"{}\"/>\n",
                   type, name, components, data_.size());
    append(data_, std::uint64_t{values.size_bytes()});
    data_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

template void VtkPolyData::add(std::string_view, std::string_view, int, std::span<const float>);
template void VtkPolyData::add(std::string_view, std::string_view, int, std::span<const std::int32_t>);
template void VtkPolyData::add(std::string_view, std::string_view, int, std::span<const glm::dvec3>);

void VtkPolyData::end() {
    if (!element_.empty()) text_ += "</" + element_ + ">\n";
}

std::string VtkPolyData::finish() {
    end();
    return text_ + "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + data_ +
           "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace spherule::recording
