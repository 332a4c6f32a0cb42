// Text formats: all snapshots in one file.
#include <iterator>

#include <fmt/format.h>

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

class Csv : public TextExporter {
  public:
    explicit Csv(OutputFile file) : TextExporter(std::move(file)) {}

  private:
    void print(const Snapshot& snapshot, std::string& text) override {
        if (!begun_) text += "time,id,x,y,z,radius,group,material\n";
        begun_ = true;
        const std::string time = fmt::format("{:.9g}", snapshot.time);
        for (std::size_t id = 0; id < snapshot.positions.size(); ++id) {
            const glm::dvec3& p = snapshot.positions[id];
            fmt::format_to(std::back_inserter(text), "{},{},{:.9g},{:.9g},{:.9g},{:.9g},{},{}\n", time, id, p.x, p.y,
                           p.z, snapshot.radii[id], snapshot.groups[id], snapshot.materials[id]);
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
        const glm::dvec3 size = snapshot.high - snapshot.low;
        const auto periodic = [&](int axis) { return snapshot.periods[axis] > 0 ? 'T' : 'F'; };
        fmt::format_to(
            std::back_inserter(text),
            "{}\nLattice=\"{:.9g} 0 0 0 {:.9g} 0 0 0 {:.9g}\" Origin=\"{:.9g} {:.9g} {:.9g}\" "
            "Properties=species:S:1:pos:R:3:radius:R:1:id:I:1:group:I:1:material:I:1 Time={:.9g} pbc=\"{} {} {}\"\n",
            snapshot.positions.size(), size.x, size.y, size.z, snapshot.low.x, snapshot.low.y, snapshot.low.z,
            snapshot.time, periodic(0), periodic(1), periodic(2));
        for (std::size_t id = 0; id < snapshot.positions.size(); ++id) {
            const glm::dvec3& p = snapshot.positions[id];
            fmt::format_to(std::back_inserter(text), "X {:.9g} {:.9g} {:.9g} {:.9g} {} {} {}\n", p.x, p.y, p.z,
                           snapshot.radii[id], id, snapshot.groups[id], snapshot.materials[id]);
        }
    }
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

}  // namespace spherule::recording
