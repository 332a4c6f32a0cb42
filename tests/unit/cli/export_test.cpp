#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include <string>

#include "cli/options.h"
#include "recording_support.h"

namespace spherule::cli {
namespace {

TEST(Export, ContainsOneOfSeveralFramesWithEqualTimes) {
    const recording::TemporaryFolder folder;
    recording::filmWithRepeatedTimes(folder / "film.sph");
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

}  // namespace
}  // namespace spherule::cli
