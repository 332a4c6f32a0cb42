// VTK's XML formats: one .vtp per snapshot with raw appended arrays, and a .pvd that lists their times.
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "recording/bytes.h"
#include "recording/exporter.h"
#include "recording/output_file.h"

namespace spherule::recording {

namespace {

// Appends an array: its size in bytes, then its bytes.
template <class T>
void appendArray(std::string& data, std::span<const T> values) {
    append(data, std::uint64_t{values.size_bytes()});
    data.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

// Returns the lengths of the periodic axes as field data; empty if there are none.
std::string periodsData(const glm::dvec3& periods) {
    if (periods == glm::dvec3(0)) return "";
    return fmt::format(
        "\n<DataArray type=\"Float64\" Name=\"Periods\" NumberOfComponents=\"3\" NumberOfTuples=\"1\" "
        "format=\"ascii\">{:.9g} {:.9g} {:.9g}</DataArray>",
        periods.x, periods.y, periods.z);
}

// Each point is also a vertex, because ParaView draws only vertices.
std::string polyData(const Snapshot& snapshot) {
    const std::size_t count = snapshot.positions.size();
    std::vector<std::int32_t> ids(count + 1);
    std::iota(ids.begin(), ids.end(), 0);
    const std::span<const std::int32_t> all(ids);
    std::string head = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
        "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:.9g}"
        "</DataArray>{}</FieldData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"0\">\n",
        snapshot.time, periodsData(snapshot.spheres->periods), count, count);
    std::string data;
    const auto array = [&](std::string_view type, std::string_view name, int components, const auto values) {
        fmt::format_to(std::back_inserter(head),
                       "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
                       "offset=\"{}\"/>\n",
                       type, name, components, data.size());
        appendArray(data, values);
    };
    head += "<PointData Scalars=\"radius\">\n";
    array("Float32", "radius", 1, std::span<const float>(snapshot.spheres->radii));
    array("Int32", "id", 1, all.first(count));
    for (const auto& [name, values] : snapshot.spheres->exportedColumns()) array("Int32", name, 1, values);
    head += "</PointData>\n<Points>\n";
    array("Float64", "Points", 3, snapshot.positions);
    head += "</Points>\n<Verts>\n";
    array("Int32", "connectivity", 1, all.first(count));
    array("Int32", "offsets", 1, all.last(count));
    head += "</Verts>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    return head + data + "\n</AppendedData>\n</VTKFile>\n";
}

// Escapes text for an XML attribute.
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

namespace fs = std::filesystem;

// A temporary folder next to the target. move() renames it, or moves its files into an existing target. Without move(),
// the destructor removes it.
class FolderBeside {
  public:
    static Result<FolderBeside> create(fs::path target, bool replace) {
        constexpr int mostNames = 100;
        std::error_code error;
        for (int k = 1; k <= mostNames; ++k) {
            fs::path place = target;
            place += k == 1 ? ".part" : fmt::format(".part{}", k);
            if (fs::create_directory(place, error)) return FolderBeside(std::move(place), std::move(target), replace);
            if (error) break;
        }
        return fail(ErrorKind::Input, target.string(), "cannot be made as a folder: " + error.message());
    }
    FolderBeside(FolderBeside&& other) noexcept
        : place_(std::exchange(other.place_, {})), target_(std::move(other.target_)), replace_(other.replace_) {}
    FolderBeside(const FolderBeside&) = delete;
    FolderBeside& operator=(const FolderBeside&) = delete;
    FolderBeside& operator=(FolderBeside&&) = delete;
    ~FolderBeside() {
        std::error_code ignored;
        if (!place_.empty()) fs::remove_all(place_, ignored);
    }

    // Path for a file of the folder. Input if the target has a file of this name and must not be replaced.
    Result<std::string> fileOf(const std::string& name) const {
        std::error_code ignored;
        if (!replace_ && fs::exists(target_ / name, ignored))
            return fail(ErrorKind::Input, (target_ / name).string(),
                        "is there already; give --force to replace it, or another name");
        return (place_ / name).string();
    }
    Result<void> move() {
        std::error_code error;
        if (!fs::exists(target_, error)) {
            fs::rename(place_, target_, error);
        } else {
            for (fs::directory_iterator file(place_, error), end; !error && file != end; file.increment(error))
                fs::rename(file->path(), target_ / file->path().filename(), error);
            if (!error) fs::remove(place_, error);
        }
        if (error) return fail(ErrorKind::Refused, target_.string(), "cannot be written: " + error.message());
        place_.clear();
        return {};
    }
    [[nodiscard]] std::string name() const { return target_.filename().string(); }

  private:
    FolderBeside(fs::path place, fs::path target, bool replace)
        : place_(std::move(place)), target_(std::move(target)), replace_(replace) {}

    fs::path place_, target_;
    bool replace_;
};

class Vtk : public Exporter {
  public:
    Vtk(OutputFile list, FolderBeside folder) : list_(std::move(list)), folder_(std::move(folder)) {}

    Result<void> add(const Snapshot& snapshot) override {
        const std::string name = fmt::format("{:06}.vtp", frames_++);
        const auto path = folder_.fileOf(name);
        if (!path) return tl::unexpected(path.error());
        auto file = OutputFile::create(*path, false);
        if (!file) return tl::unexpected(file.error());
        if (auto done = file->write(polyData(snapshot)); !done) return done;
        if (auto done = file->flush(); !done) return done;
        file->persist();
        return list_.write(fmt::format("<DataSet timestep=\"{:.9g}\" part=\"0\" file=\"{}/{}\"/>\n", snapshot.time,
                                       escaped(folder_.name()), name));
    }
    Result<void> finish() override {
        if (auto done = list_.write("</Collection>\n</VTKFile>\n"); !done) return done;
        if (auto done = folder_.move(); !done) return done;
        return list_.close();
    }
    [[nodiscard]] std::string path() const override { return list_.path(); }

  private:
    OutputFile list_;
    FolderBeside folder_;
    std::uint64_t frames_ = 0;
};

}  // namespace

MadeExporter vtkExporter(const std::string& path, bool replace) {
    fs::path folder(path);
    if (folder.extension() == ".pvd") folder.replace_extension();
    fs::path list = folder;
    list += ".pvd";
    auto file = OutputFile::create(list.string(), replace, OutputFile::Appears::WhenClosed);
    if (!file) return tl::unexpected(file.error());
    std::error_code error;
    if (fs::exists(folder, error) && !fs::is_directory(folder, error))
        return fail(ErrorKind::Input, folder.string(), "is there already, and is no folder; choose another name");
    auto beside = FolderBeside::create(std::move(folder), replace);
    if (!beside) return tl::unexpected(beside.error());
    if (auto done = file->write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
                                "byte_order=\"LittleEndian\">\n<Collection>\n");
        !done)
        return tl::unexpected(done.error());
    return std::make_unique<Vtk>(std::move(*file), std::move(*beside));
}

}  // namespace spherule::recording
