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

}  // namespace
}  // namespace spherule::host
