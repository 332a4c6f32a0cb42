#include "diagnostics/table.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "diagnostics/dial.h"
#include "scene/load.h"

namespace spherule::diagnostics {
namespace {

constexpr const char* good = R"({
  "device": "cpu", "renderer": "a processor",
  "models": {
    "balanced": [
      {"factor": 2, "curves": {"bed overlap": {"error": 0.001, "cost": 0.4, "substep": 0.001, "spheres": 100}}},
      {"factor": 1, "curves": {"bed overlap": {"error": 0.004, "cost": 0.2, "substep": 0.002, "spheres": 101},
                               "bounce apex": {"error": 1e-6, "cost": 0.1, "substep": 0.002, "spheres": 1}}}],
    "fast": [{"factor": 1, "curves": {"bed overlap": {"error": 0.2, "cost": 0.1, "substep": 0.008, "spheres": 100}}}]
  }})";

std::string with(const std::string& was, const std::string& is) {
    std::string text = good;
    return text.replace(text.find(was), was.size(), is);
}

std::string refusalOf(const std::string& text) {
    const auto table = parseTable(text, "t.json");
    return table ? "accepted" : table.error().text();
}

scene::Scene bounce() {
    auto loaded = scene::load("bounce", "cpu");
    EXPECT_TRUE(loaded);
    return *loaded;
}

TEST(QualityTable, IsSortedFromFastToAccurate) {
    const auto table = parseTable(good, "t.json");
    ASSERT_TRUE(table) << table.error().text();
    ASSERT_EQ(table->rungs.size(), 3U);
    EXPECT_EQ(table->rungs[0].model, scene::Model::Fast);
    EXPECT_EQ(table->rungs[1].factor, 1);
    EXPECT_EQ(table->rungs[2].factor, 2);
    EXPECT_EQ(table->rungs[1].curves.at("bed overlap").spheres, 101U);
}

TEST(QualityTable, BuiltInTableHasEveryModel) {
    const Table table = ownTable();
    for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate})
        EXPECT_GE(std::ranges::count(table.rungs, model, &Rung::model), 3);
    for (const Rung& rung : table.rungs) EXPECT_TRUE(rung.curves.contains("bed overlap"));
}

TEST(QualityTable, ErrorsStatePlaceAndRemedy) {
    const std::string advice = "; `spherule measure --suite accuracy --out FOLDER` writes FOLDER/measure.json";
    EXPECT_EQ(refusalOf("{\n \"device\": }"), "t.json:2:12: is not JSON" + advice);
    EXPECT_EQ(refusalOf(""), "t.json:1:1: is not JSON" + advice);
    EXPECT_EQ(refusalOf("[]"), "t.json: is no object" + advice);
    EXPECT_EQ(refusalOf("{}"), "t.json: device: is missing" + advice);
    EXPECT_EQ(refusalOf(R"({"device": 1})"), "t.json: device: is no text" + advice);
    EXPECT_EQ(refusalOf(R"({"device": "", "renderer": "", "models": {}})"), "t.json: models: has no model" + advice);
    EXPECT_EQ(refusalOf(with("fast", "swift")),
              "t.json: models.swift: is no model; there are fast, balanced and accurate" + advice);
    EXPECT_EQ(refusalOf(with("\"factor\": 2, ", "")), "t.json: models.balanced[0].factor: is missing" + advice);
    EXPECT_EQ(
        refusalOf(with("\"error\": 0.001", "\"error\": -1")),
        "t.json: models.balanced[0].curves.bed overlap.error: is \"-1\", must be a number of at least 0" + advice);
    EXPECT_EQ(
        refusalOf(with("\"cost\": 0.4", "\"cost\": \"much\"")),
        "t.json: models.balanced[0].curves.bed overlap.cost: is \"\"much\"\", must be a number of at least 1e-12" +
            advice);
    EXPECT_EQ(
        refusalOf(with("\"spheres\": 101", "\"spheres\": 0")),
        "t.json: models.balanced[1].curves.bed overlap.spheres: is \"0\", must be a number of at least 1" + advice);
    const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
    EXPECT_EQ(
        refusalOf(with("\"error\": 0.001", "\"error\": " + deep)),
        "t.json: models.balanced[0].curves.bed overlap.error: is a list, must be a number of at least 0" + advice);
    EXPECT_EQ(
        refusalOf(with("\"cost\": 0.4", "\"cost\": 1e200")),
        "t.json: models.balanced[0].curves.bed overlap.cost: is \"1e+200\", must be at most 1000000000000" + advice);
    EXPECT_EQ(refusalOf(with("1e-6", "1e999")), "t.json: holds a number that is too large" + advice);
}

TEST(QualityTable, ReadErrorsStateTheReason) {
    const auto missing = loadTable("/no/such/table.json");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().text().find("/no/such/table.json: there is no such file; `spherule measure"), 0U)
        << missing.error().text();
    EXPECT_FALSE(loadTable(std::filesystem::temp_directory_path().string()));
    EXPECT_EQ(loadTable("/dev/zero").error().text().find("/dev/zero: is a device, must be a regular file; `"), 0U);
    EXPECT_EQ(loadTable("/proc/self/mem").error().text().find("/proc/self/mem: cannot be read: Input/output error; `"),
              0U);
}

TEST(Dial, HasPositionsWithTheSubstepsOfTheScene) {
    const auto table = parseTable(good, "t.json");
    ASSERT_TRUE(table);
    const v1::Dial dial = dialFor(*table, bounce());
    ASSERT_EQ(dial.positions_size(), 3);
    EXPECT_EQ(dial.positions(0).model(), v1::FAST);
    EXPECT_EQ(dial.positions(0).substeps(), 2U);
    EXPECT_EQ(dial.positions(1).substeps(), 8U);
    EXPECT_EQ(dial.positions(2).substeps(), 16U);
    EXPECT_EQ(dial.positions(1).errors_size(), 2);
    EXPECT_TRUE(dial.positions(1).own());
    EXPECT_FALSE(dial.positions(2).own());
    EXPECT_EQ(dial.measured_on(), "cpu, a processor");
    EXPECT_EQ(dial.missing_size(), 0);
    EXPECT_FALSE(dial.calibrated());
}

TEST(Dial, EstimatesStepTimeFromSubstepsAndSpheres) {
    const auto table = parseTable(good, "t.json");
    ASSERT_TRUE(table);
    scene::Scene scene = bounce();
    ASSERT_EQ(scene.spheres.size(), 1U);
    // 0.2 ms for one sphere and 0.4 ms for 101: 2 us per further sphere. There are 8 substeps.
    EXPECT_NEAR(dialFor(*table, scene).positions(1).step_ms(), 8 * 0.2, 1e-9);
    scene.spheres.resize(501, scene.spheres.front());
    const v1::Dial dial = dialFor(*table, scene);
    EXPECT_NEAR(dial.positions(1).step_ms(), 8 * 1.2, 1e-9);
    EXPECT_NEAR(estimateMs(dial, scene::Model::Balanced, 8), 8 * 1.2, 1e-9);
    EXPECT_NEAR(estimateMs(dial, scene::Model::Balanced, 9), 9 * 1.2, 1e-9) << "by the nearest";
    EXPECT_EQ(estimateMs(dial, scene::Model::Accurate, 100), 0) << "nothing is known";
    EXPECT_NEAR(calibrated(dial, 2.5).positions(1).step_ms(), 2.5 * 8 * 1.2, 1e-9);
    EXPECT_TRUE(calibrated(dial, 2.5).calibrated());
}

TEST(Dial, OmitsModelsThatTheSceneDoesNotSupport) {
    scene::Scene scene = bounce();
    scene.materials.push_back({.name = "steel", .young = 1e9});
    const v1::Dial dial = dialFor(ownTable(), scene);
    ASSERT_EQ(dial.missing_size(), 1);
    EXPECT_EQ(dial.missing(0).model(), v1::ACCURATE);
    EXPECT_EQ(dial.missing(0).reason().find("materials[0].young: is missing"), 0U);
    for (const v1::DialPosition& position : dial.positions()) EXPECT_NE(position.model(), v1::ACCURATE);
}

}  // namespace
}  // namespace spherule::diagnostics
