#include <algorithm>
#include <map>

#include "measure/report.h"
#include "measure/svg.h"
#include "scene/quality.h"

namespace spherule::measure {

std::vector<Plot> plotsOf(const Report& report) {
    std::map<std::string, std::map<scene::Model, Line>> curves;
    for (const Outcome& outcome : report.outcomes)
        for (const Figure& figure : outcome.figures) {
            if (figure.curve.empty() || !figure.error) continue;
            Line& line = curves[figure.curve][outcome.rung.model];
            line.name = scene::nameOf(outcome.rung.model);
            line.points.push_back({outcome.cost, *figure.error});
        }
    std::vector<Plot> plots;
    for (const auto& [name, models] : curves) {
        std::vector<Line> lines;
        for (const auto& [model, line] : models) lines.push_back(line);
        plots.push_back(
            {name, logChart(name, "device seconds per simulated second, " + report.device.renderer, "error", lines)});
    }
    return plots;
}

}  // namespace spherule::measure
