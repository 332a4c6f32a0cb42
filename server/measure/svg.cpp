#include "measure/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace spherule::measure {

namespace {

constexpr double width = 640;
constexpr double height = 420;
constexpr double left = 74;
constexpr double right = 20;
constexpr double top = 44;
constexpr double bottom = 56;
constexpr std::array<const char*, 4> colours = {"#e8743b", "#3b82d0", "#4b9e5f", "#8a5bb5"};

// A logarithmic axis from one power of ten to another, which include all figures above 0.
struct Axis {
    int low = 0;   // power
    int high = 0;  // power
    double from = 0;
    double to = 0;  // picture units

    [[nodiscard]] double at(double value) const {
        const double power = value > 0 ? std::max(std::log10(value), static_cast<double>(low)) : low;
        return from + (to - from) * (power - low) / (high - low);
    }
};

Axis axisFor(const std::vector<Line>& lines, double Point::*part, double from, double to) {
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    for (const Line& line : lines)
        for (const Point& point : line.points) {
            if (!(point.*part > 0) || !std::isfinite(point.*part)) continue;
            least = std::min(least, point.*part);
            most = std::max(most, point.*part);
        }
    if (most == 0) return {0, 1, from, to};
    const int low = static_cast<int>(std::floor(std::log10(least)));
    return {low, std::max(low + 1, static_cast<int>(std::ceil(std::log10(most)))), from, to};
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else
            result += c;
    }
    return result;
}

std::string power(int exponent) {
    if (exponent >= -2 && exponent <= 3) return fmt::format("{:g}", std::pow(10, exponent));
    return fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{}</tspan>", exponent);
}

void addText(std::string& svg, double x, double y, const char* anchor, const std::string& content,
             const char* more = "") {
    fmt::format_to(std::back_inserter(svg), "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                   anchor, more, content);
}

void addRule(std::string& svg, double x1, double y1, double x2, double y2) {
    fmt::format_to(std::back_inserter(svg),
                   "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#dddddd\"/>\n", x1, y1, x2,
                   y2);
}

void addAxes(std::string& svg, const Axis& x, const Axis& y) {
    for (int k = x.low; k <= x.high; ++k) {
        const double at = x.at(std::pow(10, k));
        addRule(svg, at, y.from, at, y.to);
        addText(svg, at, y.from + 18, "middle", power(k));
    }
    for (int k = y.low; k <= y.high; ++k) {
        const double at = y.at(std::pow(10, k));
        addRule(svg, x.from, at, x.to, at);
        addText(svg, x.from - 8, at + 4, "end", power(k));
    }
}

void addLine(std::string& svg, const Line& line, const char* colour, const Axis& x, const Axis& y) {
    std::string path;
    for (const Point& point : line.points)
        fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x.at(point.x),
                       y.at(point.y));
    fmt::format_to(std::back_inserter(svg), "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", path,
                   colour);
    for (const Point& point : line.points)
        fmt::format_to(std::back_inserter(svg), "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n",
                       x.at(point.x), y.at(point.y), colour);
}

}  // namespace

std::string logChart(const std::string& title, const std::string& xName, const std::string& yName,
                     const std::vector<Line>& lines) {
    const Axis x = axisFor(lines, &Point::x, left, width - right);
    const Axis y = axisFor(lines, &Point::y, height - bottom, top);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
        "font-family=\"sans-serif\" font-size=\"12\" fill=\"#333333\">\n"
        "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>\n",
        width, height);
    addText(svg, left, 22, "start", escaped(title), " font-size=\"15\" font-weight=\"bold\"");
    addAxes(svg, x, y);
    addText(svg, (left + width - right) / 2, height - 14, "middle", escaped(xName));
    const double middle = (top + height - bottom) / 2;
    addText(svg, 16, middle, "middle", escaped(yName),
            fmt::format(" transform=\"rotate(-90 16 {:.1f})\"", middle).c_str());
    double legend = width - right;
    for (std::size_t k = lines.size(); k-- > 0;) {
        const char* colour = colours.at(k % colours.size());
        addText(svg, legend, 22, "end", escaped(lines[k].name), fmt::format(" style=\"fill:{}\"", colour).c_str());
        legend -= 18 + 7.0 * static_cast<double>(lines[k].name.size());
        if (!lines[k].points.empty()) addLine(svg, lines[k], colour, x, y);
    }
    return svg + "</svg>\n";
}

}  // namespace spherule::measure
