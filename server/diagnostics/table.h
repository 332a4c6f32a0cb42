#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"

namespace spherule::diagnostics {

// The errors of one case with a known answer.
struct Measured {
    double error = 0;
    double cost = 0;     // device seconds per simulated second
    double substep = 0;  // s
    std::uint32_t spheres = 0;
};

struct Rung {
    scene::Model model = scene::Model::Balanced;
    double factor = 1;  // substeps, as a multiple of the number that the model chooses
    std::map<std::string, Measured> curves;
};

// The results of `spherule measure`.
struct Table {
    std::string device;
    std::string renderer;
    std::vector<Rung> rungs;  // from fast to accurate, then by factor
};

// Parses the text of a measure.json. `file`: its name in errors.
Result<Table> parseTable(const std::string& text, std::string_view file);
Result<Table> loadTable(const std::string& path);
// Returns the table that is embedded in the program.
Table ownTable();

}  // namespace spherule::diagnostics
