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

// A chart with logarithmic axes as an SVG document. Points that are not above 0 lie on the lower edge, as the smallest
// figure that is shown; there is no chart without a point above 0.
std::string logChart(const std::string& title, const std::string& xName, const std::string& yName,
                     const std::vector<Line>& lines);

}  // namespace spherule::measure
