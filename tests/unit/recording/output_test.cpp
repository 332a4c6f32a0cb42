// Tests of OutputFile and the exporters: when files appear, and when they are removed.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "recording/background_writer.h"
#include "recording/exporter.h"
#include "recording/output_file.h"
#include "recording_support.h"
#include "synced_folders.h"

namespace spherule::recording {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using enum OutputFile::Appears;

class Output : public testing::Test {
  protected:
    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const auto& entry : fs::directory_iterator(folder_ / "")) result.push_back(entry.path().filename());
        std::ranges::sort(result);
        return result;
    }
    using Names = std::vector<std::string>;

    TemporaryFolder folder_;
    std::string path_ = folder_ / "out";
};

TEST_F(Output, UnfinishedFileIsRemoved) {
    {
        auto file = OutputFile::create(path_, false);
        ASSERT_TRUE(file && file->write("half") && file->flush());
        EXPECT_EQ(contentOf(path_), "half");
    }
    EXPECT_EQ(names(), Names());
    {
        auto file = OutputFile::create(path_, false);
        ASSERT_TRUE(file && file->write("half") && file->flush());
        file->persist();
    }
    EXPECT_EQ(contentOf(path_), "half");
}

// The name of a new file is on the disk with its content.
TEST_F(Output, TheFolderOfANewFileIsSyncedWithIt) {
    auto& synced = support::syncedFolders();
    const std::string folder = fs::canonical(folder_ / "").string();
    const auto syncs = [&](Result<OutputFile> file) {
        synced.clear();
        EXPECT_TRUE(file && file->write("a"));
        EXPECT_TRUE(file->flush());
        EXPECT_FALSE(synced.contains(folder));
        EXPECT_TRUE(file->sync());
        const bool first = synced.contains(folder);
        synced.clear();
        EXPECT_TRUE(file->write("b") && file->sync());
        EXPECT_FALSE(synced.contains(folder)) << "it has the name already";
        EXPECT_TRUE(file->close());
        return first;
    };
    EXPECT_TRUE(syncs(OutputFile::create(path_, false)));
    EXPECT_FALSE(syncs(OutputFile::create(path_, true))) << "it was there before";
    EXPECT_FALSE(syncs(OutputFile::goOn(path_, 1)));
    EXPECT_FALSE(syncs(OutputFile::create(folder_ / "later", false, WhenClosed)));
    EXPECT_TRUE(synced.contains(folder)) << "when it is closed";
}

TEST_F(Output, ReplacedFileStaysUntilTheFirstWrite) {
    writeFile(path_, "something long");
    EXPECT_EQ(OutputFile::create(path_, false).error().message,
              "is there already; give --force to replace it, or another name");
    { ASSERT_TRUE(OutputFile::create(path_, true)); }
    EXPECT_EQ(contentOf(path_), "something long");
    auto file = OutputFile::create(path_, true);
    ASSERT_TRUE(file && file->write("short") && file->close());
    EXPECT_EQ(contentOf(path_), "short");
}

TEST_F(Output, AppearsWhenClosed) {
    for (const bool replace : {false, true}) {
        if (replace) writeFile(path_, "old");
        {
            auto file = OutputFile::create(path_, replace, WhenClosed);
            ASSERT_TRUE(file && file->write("new") && file->flush());
            EXPECT_EQ(names(), replace ? Names({"out", "out.part"}) : Names({"out.part"}));
            EXPECT_EQ(contentOf(path_), replace ? "old" : "");
        }
        EXPECT_EQ(names(), replace ? Names({"out"}) : Names());
    }
    auto file = OutputFile::create(path_, true, WhenClosed);
    ASSERT_TRUE(file && file->write("new") && file->close());
    EXPECT_EQ(names(), Names({"out"}));
    EXPECT_EQ(contentOf(path_), "new");
}

TEST_F(Output, DoesNotReplaceAFileCreatedMeanwhile) {
    auto file = OutputFile::create(path_, false, WhenClosed);
    ASSERT_TRUE(file && file->write("new"));
    writeFile(path_, "another's");
    EXPECT_EQ(file->close().error().message, "is there already; give --force to replace it, or another name");
    EXPECT_EQ(contentOf(path_), "another's");
}

TEST_F(Output, ReplacesTheTargetOfALink) {
    writeFile(folder_ / "real", "old");
    fs::create_symlink("real", path_);
    auto file = OutputFile::create(path_, true, WhenClosed);
    ASSERT_TRUE(file && file->write("new") && file->close());
    EXPECT_TRUE(fs::is_symlink(path_));
    EXPECT_EQ(contentOf(folder_ / "real"), "new");
}

TEST_F(Output, PipesDoNotBlockAndStay) {
    ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
    for (const auto appears : {AtOnce, WhenClosed})
        EXPECT_EQ(OutputFile::create(path_, true, appears).error().message,
                  "cannot be written: it is a pipe or a socket that nobody reads");
    const int reader = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    {
        auto file = OutputFile::create(path_, true, WhenClosed);
        ASSERT_TRUE(file && file->write("text") && file->flush());
    }
    std::string text(10, '\0');
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(reader, text.data(), text.size()))));
    close(reader);
    EXPECT_EQ(text, "text");
    EXPECT_EQ(names(), Names({"out"}));
}

TEST_F(Output, DetectsADeletedFile) {
    auto file = OutputFile::create(path_, false);
    ASSERT_TRUE(file && file->write("half") && file->flush());
    file->persist();
    fs::remove(path_);
    const auto done = file->close();
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().kind, ErrorKind::Refused);
    EXPECT_EQ(done.error().message, "was deleted while it was written, or its folder was; nothing of it is kept");
}

TEST_F(Output, IdleRecordingEndsWhenItsFileIsDeleted) {
    fs::create_directory(path_);
    const Film made = film(folder_ / "film.sph", 1);
    auto writer = BackgroundWriter::create(path_ + "/film.sph", false, 0);
    ASSERT_TRUE(writer);
    v1::ServerMessage message;
    message.mutable_frame();
    ASSERT_TRUE((*writer)->add(Kind::Keyframe, 0, codec::share(std::move(message))));
    fs::remove_all(path_);
    for (int k = 0; k < 2000 && !(*writer)->progress().ended; ++k) std::this_thread::sleep_for(5ms);
    EXPECT_TRUE((*writer)->progress().ended);
    EXPECT_EQ((*writer)->progress().failure,
              "was deleted while it was written, or its folder was; nothing of it is kept");
}

TEST_F(Output, RecordingWithoutFramesIsRemoved) {
    {
        auto writer = Writer::create(path_, false, 1);
        ASSERT_TRUE(writer && writer->add(Kind::Other, 0, "abc") && writer->finish());
    }
    EXPECT_EQ(names(), Names());
}

// A snapshot of one sphere.
struct Small {
    std::vector<glm::dvec3> positions{{1, 2, 3}};
    SphereTable table{.high = {4, 4, 4}, .radii = {0.5F}, .groups = {0}, .materials = {2}, .ids = {0}};
    [[nodiscard]] Snapshot snapshot() const { return {.positions = positions, .spheres = &table}; }
};

TEST_F(Output, UnfinishedExportIsRemoved) {
    using Make = MadeExporter (*)(const std::string&, bool);
    for (const Make make : {Make(csvExporter), Make(xyzExporter), Make(vtkExporter)}) {
        {
            auto exporter = make(path_, false);
            ASSERT_TRUE(exporter && (*exporter)->add(Small().snapshot()));
            for (const std::string& name : names()) EXPECT_NE(name.find(".part"), std::string::npos) << name;
        }
        EXPECT_EQ(names(), Names());
    }
}

TEST_F(Output, ExportsHaveIdPositionRadiusAndTheColumnsOfTheTable) {
    for (const auto make : {csvExporter, xyzExporter, vtkExporter}) {
        auto exporter = make(path_ + (make == csvExporter ? ".csv" : make == xyzExporter ? ".xyz" : ""), false);
        ASSERT_TRUE(exporter && (*exporter)->add(Small().snapshot()) && (*exporter)->finish());
    }
    EXPECT_EQ(contentOf(path_ + ".csv"), "time,id,x,y,z,radius,group,material\n0,0,1,2,3,0.5,0,2\n");
    EXPECT_EQ(contentOf(path_ + ".xyz"),
              "1\nLattice=\"4 0 0 0 4 0 0 0 4\" Origin=\"0 0 0\" Properties=species:S:1:pos:R:3:radius:R:1:"
              "id:I:1:group:I:1:material:I:1 Time=0 pbc=\"F F F\"\nX 1 2 3 0.5 0 0 2\n");
    const std::string frame = contentOf(path_ + "/000000.vtp");
    std::size_t at = 0;
    for (const std::string array : {"Float32\" Name=\"radius", "Int32\" Name=\"id", "Int32\" Name=\"group",
                                    "Int32\" Name=\"material", "Float64\" Name=\"Points"}) {
        at = frame.find("<DataArray type=\"" + array + "\" NumberOfComponents", at);
        ASSERT_NE(at, std::string::npos) << array;
    }
}

TEST_F(Output, VtkReplacesOnlyItsFrames) {
    for (int round = 0; round < 2; ++round) {
        auto exporter = vtkExporter(path_ + ".pvd", round > 0);
        ASSERT_TRUE(exporter && (*exporter)->add(Small().snapshot()) && (*exporter)->finish());
        EXPECT_EQ(names(), Names({"out", "out.pvd"}));
        if (round == 0) writeFile(path_ + "/notes", "mine");
    }
    EXPECT_EQ(contentOf(path_ + "/notes"), "mine");
    EXPECT_NE(contentOf(path_ + "/000000.vtp"), "");
    fs::remove(path_ + ".pvd");
    auto exporter = vtkExporter(path_, false);
    EXPECT_EQ((*exporter)->add(Small().snapshot()).error().text(),
              path_ + "/000000.vtp: is there already; give --force to replace it, or another name");
}

}  // namespace
}  // namespace spherule::recording
