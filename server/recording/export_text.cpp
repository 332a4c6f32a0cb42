// Text formats: all snapshots in one file.
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "recording/exporter.h"
#include "recording/output_file.h"

namespace spherule::recording {

namespace {

class TextExporter : public Exporter {
  public:
    explicit TextExporter(OutputFile file) : file_(std::move(file)) {}

    Result<void> add(const Snapshot& snapshot) override {
        text_.clear();
        print(snapshot, text_);
        return file_.write(text_);
    }
    Result<void> finish() override { return file_.close(); }
    [[nodiscard]] std::string path() const override { return file_.path(); }

  protected:
    virtual void print(const Snapshot& snapshot, std::string& text) = 0;

  private:
    OutputFile file_;
    std::string text_;
};

// Prints the values of a sphere, each behind a separator.
void printValues(std::string& text, char separator, const std::vector<ExportedColumn>& columns, std::size_t id) {
    for (const ExportedColumn& column : columns)
        fmt::format_to(std::back_inserter(text), "{}{}", separator, column.values[id]);
}

class Csv : public TextExporter {
  public:
    explicit Csv(OutputFile file) : TextExporter(std::move(file)) {}

  private:
    void print(const Snapshot& snapshot, std::string& text) override {
        const auto columns = snapshot.spheres->exportedColumns();
        if (!std::exchange(begun_, true)) {
            text += "time,id,x,y,z,radius";
            for (const ExportedColumn& column : columns) fmt::format_to(std::back_inserter(text), ",{}", column.name);
            text += '\n';
        }
        const std::string time = fmt::format("{:.9g}", snapshot.time);
        for (std::size_t id = 0; id < snapshot.positions.size(); ++id) {
            const glm::dvec3& p = snapshot.positions[id];
            fmt::format_to(std::back_inserter(text), "{},{},{:.9g},{:.9g},{:.9g},{:.9g}", time, id, p.x, p.y, p.z,
                           snapshot.spheres->radii[id]);
            printValues(text, ',', columns, id);
            text += '\n';
        }
    }
    bool begun_ = false;
};

// Species X is ASE's name for a particle that is no element.
class Xyz : public TextExporter {
  public:
    explicit Xyz(OutputFile file) : TextExporter(std::move(file)) {}

  private:
    void print(const Snapshot& snapshot, std::string& text) override {
        const SphereTable& spheres = *snapshot.spheres;
        const auto columns = spheres.exportedColumns();
        const glm::dvec3 size = spheres.high - spheres.low;
        const auto periodic = [&](int axis) { return spheres.periods[axis] > 0 ? 'T' : 'F'; };
        fmt::format_to(std::back_inserter(text),
                       "{}\nLattice=\"{:.9g} 0 0 0 {:.9g} 0 0 0 {:.9g}\" Origin=\"{:.9g} {:.9g} {:.9g}\" "
                       "Properties=species:S:1:pos:R:3:radius:R:1:id:I:1",
                       snapshot.positions.size(), size.x, size.y, size.z, spheres.low.x, spheres.low.y, spheres.low.z);
        for (const ExportedColumn& column : columns) fmt::format_to(std::back_inserter(text), ":{}:I:1", column.name);
        fmt::format_to(std::back_inserter(text), " Time={:.9g} pbc=\"{} {} {}\"\n", snapshot.time, periodic(0),
                       periodic(1), periodic(2));
        for (std::size_t id = 0; id < snapshot.positions.size(); ++id) {
            const glm::dvec3& p = snapshot.positions[id];
            fmt::format_to(std::back_inserter(text), "X {:.9g} {:.9g} {:.9g} {:.9g} {}", p.x, p.y, p.z,
                           spheres.radii[id], id);
            printValues(text, ' ', columns, id);
            text += '\n';
        }
    }
};

// The poses of v1::Pose.
class Poses : public TextExporter {
  public:
    explicit Poses(OutputFile file) : TextExporter(std::move(file)) {}

  private:
    void print(const Snapshot& snapshot, std::string& text) override {
        if (!std::exchange(begun_, true)) text += "time,obstacle,x,y,z,qx,qy,qz,qw\n";
        for (const v1::Pose& pose : snapshot.poses)
            fmt::format_to(std::back_inserter(text), "{:.9g},{},{:.12g},{:.12g}\n", snapshot.time, pose.obstacle(),
                           fmt::join(pose.translation(), ","), fmt::join(pose.rotation(), ","));
    }
    bool begun_ = false;
};

template <class Format>
MadeExporter make(const std::string& path, bool replace) {
    auto file =
        path == "-" ? OutputFile::standardOutput() : OutputFile::create(path, replace, OutputFile::Appears::WhenClosed);
    if (!file) return tl::unexpected(file.error());
    return std::make_unique<Format>(std::move(*file));
}

}  // namespace

MadeExporter csvExporter(const std::string& path, bool replace) {
    return make<Csv>(path, replace);
}

MadeExporter xyzExporter(const std::string& path, bool replace) {
    return make<Xyz>(path, replace);
}

MadeExporter posesExporter(const std::string& path, bool replace) {
    return make<Poses>(path, replace);
}

}  // namespace spherule::recording
