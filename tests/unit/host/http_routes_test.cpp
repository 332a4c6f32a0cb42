#include "host/http_routes.h"

#include <gtest/gtest.h>

#include <string>

#include <nlohmann/json.hpp>

namespace spherule::host {
namespace {

TEST(HttpRoutes, ReadinessIsValidJsonForNamesInAnyEncoding) {
    StatusBoard board;
    board.update([](ServerStatus& report) {
        report.scene = std::string("caf\xe9");  // a file name in Latin 1
        report.device.renderer = std::string("\xff");
    });
    const Watchdog watchdog(Watchdog::Seconds(0));
    HttpRoutes routes(board, watchdog);
    const auto answer = routes.get("/readyz", net::Counters());
    EXPECT_EQ(nlohmann::json::parse(answer.body).at("scene"), "caf\xef\xbf\xbd");
}

TEST(HttpRoutes, OnlyFinishedRecordingsOfThisServerAreDownloads) {
    StatusBoard board;
    board.update([](ServerStatus& report) {
        report.recordings = {"kept/first.sph", "kept/second.sph"};
        report.recording.set_file("kept/second.sph");
        report.recording.set_active(true);
    });
    const Watchdog watchdog(Watchdog::Seconds(0));
    const HttpRoutes routes(board, watchdog);
    EXPECT_EQ(routes.download("/recordings/first.sph"), "kept/first.sph");
    for (const char* const path :
         {"/recordings/second.sph", "/recordings/third.sph", "/recordings/", "/recordings/kept/first.sph",
          "/recordings/../kept/first.sph", "/recordings/%66irst.sph", "/first.sph", "first.sph"})
        EXPECT_EQ(routes.download(path), std::nullopt) << path;
    board.update([](ServerStatus& report) { report.recording.set_active(false); });
    EXPECT_EQ(routes.download("/recordings/second.sph"), "kept/second.sph");
}

}  // namespace
}  // namespace spherule::host
