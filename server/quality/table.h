#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"

namespace spherule::quality {

// The errors of one case with a known answer.
struct Measured {
    double error = 0;
    double cost = 0;     // device seconds per simulated second
    double substep = 0;  // s
    std::uint32_t spheres = 0;
};

struct Rung {
    scene::Model model = scene::Model::Balanced;
    double factor = 1;  // substeps, as a multiple of those that the model would choose
    std::map<std::string, Measured> curves;
};

// The results of `spherule measure`.
struct Table {
    std::string device;
    std::string renderer;
    std::vector<Rung> rungs;  // from fast to accurate, each model's by factor
};

// The text of a measure.json; `file` only names it in errors.
Result<Table> parseTable(const std::string& text, std::string_view file);
Result<Table> loadTable(const std::string& path);
// The one that comes with the program.
Table ownTable();

}  // namespace spherule::quality
