#include "figures.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace spherule::bench {

namespace {

template <class T>
void addOnce(std::vector<T>& values, const T& value) {
    if (std::ranges::find(values, value) == values.end()) values.push_back(value);
}

// Formats a number with at least three significant digits, but at most six decimals.
std::string number(double value) {
    if (value == 0) return "0";
    const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    return fmt::format("{:.{}f}", value, std::clamp(3 - before, 0, 6));
}

std::string cell(const Figures& figures, const Figure& figure) {
    if (!figure.value) return "-";
    const std::string text = number(*figure.value);
    const auto reference = valueOf(figures, figure.table, figure.spheres, "ours");
    if (!reference || figure.what == "ours") return text;
    return fmt::format("{} ({}x)", text, number(*figure.value / *reference));
}

Table tableOf(const Figures& figures, const std::string& name) {
    std::vector<std::uint32_t> sizes;
    std::vector<std::string> whats;
    for (const Figure& figure : figures) {
        if (figure.table != name) continue;
        addOnce(sizes, figure.spheres);
        addOnce(whats, figure.what);
    }
    Table table{name, {{"spheres"}}, {}};
    for (const std::uint32_t size : sizes) table.rows.front().push_back(fmt::format("{}", size));
    for (const std::string& what : whats) {
        std::vector<std::string> row = {what};
        std::vector<std::string> notes;
        for (const std::uint32_t size : sizes) {
            const auto found = std::ranges::find_if(figures, [&](const Figure& figure) {
                return figure.table == name && figure.spheres == size && figure.what == what;
            });
            row.push_back(found == figures.end() ? "" : cell(figures, *found));
            if (found == figures.end()) continue;
            if (!found->unit.empty()) row.front() = what + ", " + found->unit;
            if (!found->note.empty()) notes.push_back(fmt::format("{}: {}", size, found->note));
        }
        table.rows.push_back(row);
        if (!notes.empty()) table.notes.push_back(fmt::format("{}: {}.", what, fmt::join(notes, "; ")));
    }
    return table;
}

}  // namespace

std::optional<double> valueOf(const Figures& figures, const std::string& table, std::uint32_t spheres,
                              const std::string& what) {
    for (const Figure& figure : figures)
        if (figure.table == table && figure.spheres == spheres && figure.what == what) return figure.value;
    return std::nullopt;
}

std::vector<Table> tablesOf(const Figures& figures) {
    std::vector<std::string> names;
    for (const Figure& figure : figures) addOnce(names, figure.table);
    std::vector<Table> tables;
    for (const std::string& name : names) tables.push_back(tableOf(figures, name));
    return tables;
}

}  // namespace spherule::bench
