// VTK's XML files: one .vtp per moment, its arrays appended as they are, and a .pvd that says when each is.
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "store/bytes.h"
#include "store/exporter.h"
#include "store/output_file.h"

namespace spherule::store {

namespace {

// An array of the appended data: its size in bytes, then its bytes.
template <class T>
void appendArray(std::string& data, std::span<const T> values) {
    append(data, std::uint64_t{values.size_bytes()});
    data.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

// Each point is a vertex too: without them ParaView shows nothing.
std::string polyData(const Moment& moment) {
    const std::size_t count = moment.positions.size();
    std::vector<std::int32_t> ids(count + 1);
    std::iota(ids.begin(), ids.end(), 0);
    const std::span<const std::int32_t> all(ids);
    std::string head = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
        "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:.9g}"
        "</DataArray></FieldData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"0\">\n",
        moment.time, count, count);
    std::string data;
    const auto array = [&](const char* type, const char* name, int components, const auto values) {
        fmt::format_to(std::back_inserter(head),
                       "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
                       "offset=\"{}\"/>\n",
                       type, name, components, data.size());
        appendArray(data, values);
    };
    head += "<PointData Scalars=\"radius\">\n";
    array("Float32", "radius", 1, moment.radii);
    array("Int32", "id", 1, all.first(count));
    head += "</PointData>\n<Points>\n";
    array("Float64", "Points", 3, moment.positions);
    head += "</Points>\n<Verts>\n";
    array("Int32", "connectivity", 1, all.first(count));
    array("Int32", "offsets", 1, all.last(count));
    head += "</Verts>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    return head + data + "\n</AppendedData>\n</VTKFile>\n";
}

// As the value of an attribute.
std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '"')
            safe += "&quot;";
        else
            safe += c;
    }
    return safe;
}

class Vtk : public Exporter {
  public:
    Vtk(OutputFile list, std::filesystem::path folder, bool replace)
        : list_(std::move(list)), folder_(std::move(folder)), replace_(replace) {}

    Result<void> add(const Moment& moment) override {
        const std::string name = fmt::format("{:06}.vtp", frames_++);
        auto file = OutputFile::create((folder_ / name).string(), replace_);
        if (!file) return tl::unexpected(file.error());
        if (auto done = file->write(polyData(moment)); !done) return done;
        if (auto done = file->flush(); !done) return done;
        return list_.write(fmt::format("<DataSet timestep=\"{:.9g}\" part=\"0\" file=\"{}/{}\"/>\n", moment.time,
                                       escaped(folder_.filename().string()), name));
    }
    Result<void> finish() override {
        if (auto done = list_.write("</Collection>\n</VTKFile>\n"); !done) return done;
        return list_.close();
    }
    [[nodiscard]] std::string path() const override { return list_.path(); }

  private:
    OutputFile list_;
    std::filesystem::path folder_;
    bool replace_;
    std::uint64_t frames_ = 0;
};

}  // namespace

MadeExporter vtkExporter(const std::string& path, bool replace) {
    std::filesystem::path folder(path);
    if (folder.extension() == ".pvd") folder.replace_extension();
    std::filesystem::path list = folder;
    list += ".pvd";
    auto file = OutputFile::create(list.string(), replace);
    if (!file) return tl::unexpected(file.error());
    std::error_code error;
    std::filesystem::create_directory(folder, error);
    if (error) return fail(ErrorKind::Input, folder.string(), "cannot be made as a folder: " + error.message());
    if (auto done = file->write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                                "byte_order=\"LittleEndian\">\n<Collection>\n");
        !done)
        return tl::unexpected(done.error());
    return std::make_unique<Vtk>(std::move(*file), std::move(folder), replace);
}

}  // namespace spherule::store
