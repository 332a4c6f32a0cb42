#pragma once

#include <string>
#include <vector>

namespace spherule::measure {

struct Point {
    double x = 0;
    double y = 0;
};

struct Line {
    std::string name;
    std::vector<Point> points;
};

// Returns a chart with logarithmic axes as an SVG document. Values that are not above 0 are drawn at the low end of the
// axis.
std::string logChart(const std::string& title, const std::string& xName, const std::string& yName,
                     const std::vector<Line>& lines);

}  // namespace spherule::measure
