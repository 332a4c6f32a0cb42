#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace spherule::bench {

// One measured value, or why there is none.
struct Figure {
    std::string table;
    std::uint32_t spheres = 0;
    std::string what;             // a method, a pass, a property of the state
    std::optional<double> value;  // in `unit`
    std::string unit;
    std::string note;
};

using Figures = std::vector<Figure>;

// The value of `what` at a size in a table, if there is one.
std::optional<double> valueOf(const Figures& figures, const std::string& table, std::uint32_t spheres,
                              const std::string& what);

// Tables by name, with one column per size and one row per `what`, both in the order in which they came. Where a table
// has a row `ours`, the others also say how many times ours they are.
struct Table {
    std::string name;
    std::vector<std::vector<std::string>> rows;  // the first is the head
    std::vector<std::string> notes;
};
std::vector<Table> tablesOf(const Figures& figures);

}  // namespace spherule::bench
