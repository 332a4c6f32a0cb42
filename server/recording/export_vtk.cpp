// VTK's XML formats: .vtp files of spheres and obstacles, and a .pvd that lists their times.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "recording/exporter.h"
#include "recording/output_file.h"
#include "recording/vtk_poly_data.h"
#include "scene/tessellation.h"

namespace spherule::recording {

namespace {

// Returns the lengths of the periodic axes as field data; empty if there are none.
std::string periodsData(const glm::dvec3& periods) {
    if (periods == glm::dvec3(0)) return "";
    return fmt::format(
        "\n<DataArray type=\"Float64\" Name=\"Periods\" NumberOfComponents=\"3\" NumberOfTuples=\"1\" "
        "format=\"ascii\">{:.9g} {:.9g} {:.9g}</DataArray>",
        periods.x, periods.y, periods.z);
}

std::string timeData(double time) {
    return fmt::format(
        "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:.9g}</DataArray>",
        time);
}

// Each point is also a vertex, because ParaView draws only vertices.
std::string spheresData(const Snapshot& snapshot) {
    const std::size_t count = snapshot.positions.size();
    std::vector<std::int32_t> ids(count + 1);
    std::iota(ids.begin(), ids.end(), 0);
    const std::span<const std::int32_t> all(ids);
    VtkPolyData file({.points = count, .vertices = count},
                     timeData(snapshot.time) + periodsData(snapshot.spheres->periods));
    file.begin("PointData", " Scalars=\"radius\"");
    file.array("radius", std::span<const float>(snapshot.spheres->radii));
    file.array("id", all.first(count));
    for (const auto& [name, values] : snapshot.spheres->exportedColumns()) file.array(name, values);
    file.begin("Points");
    file.array("Points", snapshot.positions);
    file.begin("Verts");
    file.array("connectivity", all.first(count));
    file.array("offsets", all.last(count));
    return file.finish();
}

// The surfaces of some obstacles, with the number of its obstacle for each triangle.
struct Surfaces {
    scene::Tessellation triangles;
    std::vector<std::int32_t> obstacles;

    void add(const Snapshot& snapshot, int obstacle, const scene::Frame& pose) {
        const scene::Box bounds{snapshot.spheres->low, snapshot.spheres->high};
        const auto& meshes = snapshot.facts->meshes();
        const auto mesh =
            std::ranges::find_if(meshes, [&](const auto& one) { return int(one.obstacle()) == obstacle; });
        triangles.append(scene::tessellationOf(snapshot.facts->obstacles(obstacle),
                                               mesh == meshes.end() ? nullptr : &*mesh, pose, bounds));
        obstacles.resize(triangles.corners.size(), obstacle);
    }
};

std::string surfacesData(const Surfaces& surfaces, const std::string& fields) {
    const auto& [points, corners] = surfaces.triangles;
    std::vector<std::int32_t> connectivity;
    std::vector<std::int32_t> offsets;
    for (const glm::uvec3& each : corners) {
        for (int k = 0; k < 3; ++k) connectivity.push_back(static_cast<std::int32_t>(each[k]));
        offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
    }
    VtkPolyData file({.points = points.size(), .polygons = corners.size()}, fields);
    file.begin("CellData", " Scalars=\"obstacle\"");
    file.array("obstacle", std::span<const std::int32_t>(surfaces.obstacles));
    file.begin("Points");
    file.array("Points", std::span<const glm::dvec3>(points));
    file.begin("Polys");
    file.array("connectivity", std::span<const std::int32_t>(connectivity));
    file.array("offsets", std::span<const std::int32_t>(offsets));
    return file.finish();
}

// The obstacles without a pose.
Surfaces atRest(const Snapshot& snapshot) {
    Surfaces surfaces;
    for (int k = 0; k < snapshot.facts->obstacles_size(); ++k)
        if (std::ranges::none_of(snapshot.poses, [&](const v1::Pose& pose) { return int(pose.obstacle()) == k; }))
            surfaces.add(snapshot, k, {});
    return surfaces;
}

// The obstacles with a pose, where they are.
Surfaces moving(const Snapshot& snapshot) {
    Surfaces surfaces;
    for (const v1::Pose& pose : snapshot.poses) {
        const auto& [to, turn] = std::pair(pose.translation(), pose.rotation());
        const scene::Frame frame{.turn = glm::mat3_cast(glm::dquat(turn[3], turn[0], turn[1], turn[2])),
                                 .origin = {to[0], to[1], to[2]}};
        surfaces.add(snapshot, static_cast<int>(pose.obstacle()), frame);
    }
    return surfaces;
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
        const std::string number = fmt::format("{:06}", frames_++);
        if (auto done = addPart(snapshot.time, 0, number + ".vtp", spheresData(snapshot)); !done) return done;
        if (scene_ != snapshot.scene || frames_ == 1) {
            scene_ = snapshot.scene;
            const Surfaces surfaces = atRest(snapshot);
            resting_ = surfaces.obstacles.empty() ? "" : number + "-obstacles.vtp";
            if (!resting_.empty())
                if (auto done = writeFile(resting_, surfacesData(surfaces, "")); !done) return done;
        }
        if (!resting_.empty())
            if (auto done = list(snapshot.time, 1, resting_); !done) return done;
        const Surfaces surfaces = moving(snapshot);
        if (surfaces.obstacles.empty()) return {};
        return addPart(snapshot.time, 2, number + "-moving.vtp", surfacesData(surfaces, timeData(snapshot.time)));
    }
    Result<void> finish() override {
        if (auto done = list_.write("</Collection>\n</VTKFile>\n"); !done) return done;
        if (auto done = folder_.move(); !done) return done;
        return list_.close();
    }
    [[nodiscard]] std::string path() const override { return list_.path(); }

  private:
    Result<void> addPart(double time, int part, const std::string& name, const std::string& content) {
        if (auto done = writeFile(name, content); !done) return done;
        return list(time, part, name);
    }
    Result<void> writeFile(const std::string& name, const std::string& content) {
        const auto path = folder_.fileOf(name);
        if (!path) return tl::unexpected(path.error());
        auto file = OutputFile::create(*path, false);
        if (!file) return tl::unexpected(file.error());
        if (auto done = file->write(content); !done) return done;
        if (auto done = file->flush(); !done) return done;
        file->persist();
        return {};
    }
    Result<void> list(double time, int part, const std::string& name) {
        return list_.write(fmt::format("<DataSet timestep=\"{:.9g}\" part=\"{}\" file=\"{}/{}\"/>\n", time, part,
                                       escaped(folder_.name()), name));
    }

    OutputFile list_;
    FolderBeside folder_;
    std::uint64_t frames_ = 0;
    std::uint64_t scene_ = 0;  // of the last snapshot
    std::string resting_;      // file of its obstacles at rest; empty: it has none
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
