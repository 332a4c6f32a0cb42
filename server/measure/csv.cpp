#include <fmt/format.h>

#include <iterator>

#include "measure/report.h"
#include "scene/quality.h"

namespace spherule::measure {

namespace {

// Quotes a field as in RFC 4180.
std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + "\"";
}

std::string numberOr(const std::optional<double>& number) {
    return number ? fmt::format("{:.9g}", *number) : "";
}

}  // namespace

std::string csvOf(const Report& report) {
    std::string text =
        "suite,case,figure,model,factor,substeps,substep_s,value,expected,error,unit,verdict,spheres,"
        "device_seconds_per_simulated_second,renderer\n";
    const auto row = [&](const Outcome& o, const Figure& f, const std::string& value) {
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{:g},{},{:.6g},{},{},{},{},{},{},{:.4g},{}\n", o.suite,
                       quoted(o.name), quoted(f.name), scene::nameOf(o.rung.model), o.rung.factor, o.substeps,
                       o.substep, value, numberOr(f.expected), numberOr(f.error), quoted(f.unit), quoted(f.verdict),
                       o.spheres, o.cost, quoted(report.device.renderer));
    };
    for (const Outcome& outcome : report.outcomes) {
        for (const Figure& figure : outcome.figures) row(outcome, figure, numberOr(figure.value));
        if (outcome.trouble.empty()) continue;
        Figure trouble;
        trouble.verdict = "not measured: " + outcome.trouble;
        row(outcome, trouble, "");
    }
    return text;
}

}  // namespace spherule::measure
