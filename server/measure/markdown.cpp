#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "measure/overview.h"
#include "measure/report.h"
#include "scene/quality.h"

namespace spherule::measure {

namespace {

// Escapes text for a table cell: a bar would end the cell.
std::string cell(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
    return result;
}

std::string number(const std::optional<double>& value) {
    return value ? fmt::format("{:.4g}", *value) : "";
}

void addRow(std::string& text, const Outcome& o, const Figure& f) {
    fmt::format_to(std::back_inserter(text), "| {} | {} | {:.3g} | {} | {} | {} | {} | {} |\n", cell(f.name),
                   nameOf(o.rung), 1 / o.substep, number(f.value), number(f.expected), cell(f.unit), number(f.error),
                   cell(f.verdict));
}

// Adds all outcomes of one case. The rungs of a figure are in consecutive rows.
void addCase(std::string& text, const std::vector<const Outcome*>& outcomes) {
    fmt::format_to(std::back_inserter(text), "\n### {}\n\n", outcomes.front()->name);
    std::vector<std::string> names;
    for (const Outcome* outcome : outcomes)
        for (const Figure& figure : outcome->figures)
            if (std::ranges::find(names, figure.name) == names.end()) names.push_back(figure.name);
    if (!names.empty())
        text +=
            "| figure | model | substeps/s | value | expected | unit | error | verdict "
            "|\n|---|---|---|---|---|---|---|---|\n";
    for (const std::string& name : names)
        for (const Outcome* outcome : outcomes)
            for (const Figure& figure : outcome->figures)
                if (figure.name == name) addRow(text, *outcome, figure);
    for (const Outcome* outcome : outcomes)
        if (!outcome->trouble.empty())
            fmt::format_to(std::back_inserter(text), "\nNot measured with {}: {}\n", nameOf(outcome->rung),
                           outcome->trouble);
}

}  // namespace

std::string markdownOf(const Report& report) {
    std::string text =
        fmt::format("# Measured\n\n`{}`\n\nOn {} ({}).\n", report.command, report.device.renderer, report.device.kind);
    text +=
        "\nA model's `x2` takes twice as many substeps as it would choose for the scene. Errors are fractions of the "
        "expected value, or of the scale that the figure names.\n";
    text += overviewOf(report);
    std::string suite;
    for (std::size_t k = 0; k < report.outcomes.size();) {
        std::vector<const Outcome*> same;
        const Outcome& first = report.outcomes[k];
        while (k < report.outcomes.size() && report.outcomes[k].name == first.name)
            same.push_back(&report.outcomes[k++]);
        if (first.suite != suite) {
            suite = first.suite;
            fmt::format_to(std::back_inserter(text), "\n## {}\n", suite);
        }
        addCase(text, same);
    }
    return text;
}

}  // namespace spherule::measure
