#include <gtest/gtest.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "measure/report.h"
#include "measure/svg.h"

namespace spherule::measure {
namespace {

Report sample() {
    Figure apex = against("apex, \"worst\"", 0.98, 1, "m");
    apex.curve = "bounce apex";
    Figure verdict = plain("at 100 m/s", 3, "of 40");
    verdict.verdict = "fails: 3 of 40 | lost";
    Report report;
    report.command = "spherule measure";
    report.device.renderer = "a <renderer>, & more";
    report.outcomes.push_back({.suite = "accuracy",
                               .name = "bounce",
                               .rung = {scene::Model::Fast, 2},
                               .substeps = 4,
                               .substep = 0.25,
                               .spheres = 1,
                               .cost = 0.5,
                               .figures = {apex, verdict},
                               .trouble = ""});
    report.outcomes.push_back({.suite = "accuracy",
                               .name = "bounce",
                               .rung = {scene::Model::Accurate, 1},
                               .figures = {},
                               .trouble = "too dear"});
    return report;
}

std::size_t linesOf(const std::string& text) {
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

TEST(ReportFiles, ErrorsAreRelativeToTheExpectedValueOrAScale) {
    EXPECT_DOUBLE_EQ(*against("", 1.5, 2, "").error, 0.25);
    EXPECT_DOUBLE_EQ(*against("", 0.5, 0, "", 10).error, 0.05);
    EXPECT_FALSE(plain("", 1, "").error);
}

TEST(ReportFiles, CsvHasRowPerFigureAndPerProblem) {
    const std::string csv = csvOf(sample());
    EXPECT_EQ(linesOf(csv), 4U);
    EXPECT_NE(csv.find("\naccuracy,bounce,\"apex, \"\"worst\"\"\",fast,2,4,0.25,0.98,1,0.02,m,,1,0.5,"),
              std::string::npos);
    EXPECT_NE(csv.find("not measured: too dear"), std::string::npos);
}

TEST(ReportFiles, TablesEscapeBarsAndShowProblems) {
    const std::string text = markdownOf(sample());
    EXPECT_NE(text.find("fails: 3 of 40 \\| lost"), std::string::npos);
    EXPECT_NE(text.find("## What fails\n\nOf 1 verdicts"), std::string::npos);
    EXPECT_NE(text.find("| fast x2 | 0.02 for 0.5 s |"), std::string::npos);
    EXPECT_NE(text.find("Not measured with accurate x1: too dear"), std::string::npos);
}

TEST(ReportFiles, JsonHasCurvesByModelAndRungAndEveryVerdict) {
    const auto json = nlohmann::json::parse(jsonOf(sample()));
    const auto& rung = json.at("models").at("fast").at(0);
    EXPECT_EQ(rung.at("factor"), 2);
    EXPECT_DOUBLE_EQ(rung.at("curves").at("bounce apex").at("error").get<double>(), 0.02);
    EXPECT_EQ(rung.at("curves").at("bounce apex").at("cost"), 0.5);
    EXPECT_EQ(json.at("verdicts").size(), 2U);
}

TEST(ReportFiles, ChartContainsEveryPointAndEscapesNames) {
    const std::string svg = logChart("a < b & c", "x", "y", {{"one", {{1, 1e-3}, {10, 0}, {100, 1e2}}}, {"two", {}}});
    EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
    std::size_t circles = 0;
    for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++circles;
    EXPECT_EQ(circles, 3U);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    EXPECT_NE(logChart("none", "x", "y", {}).find("</svg>"), std::string::npos);
}

TEST(ReportFiles, PlotHasALinePerModel) {
    const std::vector<Plot> plots = plotsOf(sample());
    ASSERT_EQ(plots.size(), 1U);
    EXPECT_EQ(plots[0].name, "bounce apex");
    EXPECT_NE(plots[0].svg.find("&lt;renderer&gt;, &amp; more"), std::string::npos);
}

}  // namespace
}  // namespace spherule::measure
