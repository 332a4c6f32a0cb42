#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace spherule::bench {

// One measured value, or the reason why it is missing.
struct Figure {
    std::string table;
    std::uint32_t spheres = 0;
    std::string what;             // a method, a pass, a property of the state
    std::optional<double> value;  // in `unit`
    std::string unit;
    std::string note;
};

using Figures = std::vector<Figure>;

// Returns the value of `what` for a number of spheres in a table; nullopt if there is none.
std::optional<double> valueOf(const Figures& figures, const std::string& table, std::uint32_t spheres,
                              const std::string& what);

// One table per name, with one column per number of spheres and one row per `what`, in order of their first figures.
// If a table has a row `ours`, the other rows also give the ratio to it.
struct Table {
    std::string name;
    std::vector<std::vector<std::string>> rows;  // the first is the header
    std::vector<std::string> notes;
};
std::vector<Table> tablesOf(const Figures& figures);

}  // namespace spherule::bench
