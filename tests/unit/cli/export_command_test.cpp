#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

#include "app/options.h"
#include "app/player.h"
#include "recording/record.h"
#include "recording_support.h"

namespace spherule::app {
namespace {

// Writes a film in which each two frames have the same time, as when the simulation was paused.
void doubled(const std::string& path) {
    recording::film(path, 10);
    const auto file = recording::RecordFile::open(path);
    std::string content = recording::fileHead();
    std::uint64_t offset = recording::fileHeadBytes;
    for (auto record = file->read(offset); record; record = file->read(record->end))
        if (record->kind != recording::Kind::Index)
            content += recording::recordBytes(record->kind, std::floor(5 * record->time + 0.01) / 5, record->payload);
    recording::writeFile(path, content);
}

TEST(Export, OfFramesOfOneTimeHasOne) {
    const recording::TemporaryFolder folder;
    doubled(folder / "film.sph");
    CLI::App app;
    int code = -1;
    addExport(app, code);
    app.parse("export " + (folder / "film.sph") + " --format vtk --out " + (folder / "film.pvd"));
    EXPECT_EQ(code, 0);
    const std::string list = recording::contentOf(folder / "film.pvd");
    for (const char* const time : {"\"0\"", "\"0.2\"", "\"0.4\"", "\"0.6\"", "\"0.8\""}) {
        const auto first = list.find(std::string("timestep=") + time);
        EXPECT_NE(first, std::string::npos) << time << " in " << list;
        EXPECT_EQ(list.find(std::string("timestep=") + time, first + 1), std::string::npos) << time << " in " << list;
    }
}

TEST(Player, OfFramesOfOneTimeShowsOne) {
    const recording::TemporaryFolder folder;
    doubled(folder / "film.sph");
    Player::Clock::time_point now{};
    Player player(recording::Recording::open(folder / "film.sph").value(), "film.sph", false, now);
    player.advance(now);
    v1::Command step;
    step.mutable_step()->set_count(1);
    for (int k = 1; k < 5; ++k) {
        ASSERT_TRUE(player.apply(step, now));
        EXPECT_TRUE(player.advance(now += std::chrono::seconds(1)).shown);
        EXPECT_NEAR(player.recording().time(), 0.2 * k, 1e-9);
    }
}

}  // namespace
}  // namespace spherule::app
