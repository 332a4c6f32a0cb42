#include "measure/overview.h"

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <set>

#include "scene/quality.h"

namespace spherule::measure {

namespace {

void addFailures(std::string& text, const Report& report) {
    std::size_t verdicts = 0;
    std::string failures;
    for (const Outcome& outcome : report.outcomes)
        for (const Figure& figure : outcome.figures) {
            if (figure.verdict.empty()) continue;
            ++verdicts;
            if (figure.verdict != "pass")
                fmt::format_to(std::back_inserter(failures), "| {} | {} | {} | {} |\n", nameOf(outcome.rung),
                               outcome.name, figure.name, figure.verdict);
        }
    if (verdicts == 0) return;
    fmt::format_to(std::back_inserter(text), "\n## What fails\n\nOf {} verdicts:\n\n", verdicts);
    text += failures.empty() ? "none.\n" : "| model | case | figure | verdict |\n|---|---|---|---|\n" + failures;
}

// Adds the main errors: one row per model and rung, one column per curve.
void addErrors(std::string& text, const Report& report) {
    std::set<std::string> curves;
    std::map<std::pair<scene::Model, double>, std::map<std::string, std::string>> rows;
    for (const Outcome& outcome : report.outcomes)
        for (const Figure& figure : outcome.figures) {
            if (figure.curve.empty() || !figure.error) continue;
            curves.insert(figure.curve);
            rows[{outcome.rung.model, outcome.rung.factor}][figure.curve] =
                fmt::format("{:.2g} for {:.2g} s", *figure.error, outcome.cost);
        }
    if (curves.empty()) return;
    text += "\n## At a glance\n\nErrors, and the device seconds per simulated second that they cost.\n\n| model |";
    for (const std::string& curve : curves) text += " " + curve + " |";
    text += "\n|---|";
    for (std::size_t k = 0; k < curves.size(); ++k) text += "---|";
    text += "\n";
    for (const auto& [rung, errors] : rows) {
        text += "| " + nameOf({rung.first, rung.second}) + " |";
        for (const std::string& curve : curves) {
            const auto found = errors.find(curve);
            text += " " + (found == errors.end() ? "" : found->second) + " |";
        }
        text += "\n";
    }
}

}  // namespace

std::string overviewOf(const Report& report) {
    std::string text;
    addErrors(text, report);
    addFailures(text, report);
    return text;
}

}  // namespace spherule::measure
