#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

// The results of `spherule measure`: figures of cases, each at a model and at a number of substeps.
namespace spherule::measure {

// A model, and its number of substeps as a multiple of the number that the model chooses.
struct Rung {
    scene::Model model = scene::Model::Balanced;
    double factor = 1;
};

struct Figure {
    std::string name;
    double value = 0;
    std::optional<double> expected{};
    std::optional<double> error{};  // relative to the expected value, unless the case defines another error
    std::string unit{};             // of value and expected
    std::string curve{};            // the work-precision curve that shows the error; empty: none
    std::string verdict{};          // "pass", the failure, or the reason of a refusal; empty: only measured
};

// A figure with its error relative to the expected value, or to `scale` if that is not 0.
Figure against(std::string name, double value, double expected, std::string unit, double scale = 0);

// A figure without an expected value.
Figure plain(std::string name, double value, std::string unit);

// The result of one case at one rung.
struct Outcome {
    std::string suite;
    std::string name;
    Rung rung;
    std::uint32_t substeps = 0;  // per step
    double substep = 0;          // s
    std::uint32_t spheres = 0;
    double cost = 0;  // device seconds per simulated second
    std::vector<Figure> figures;
    std::string trouble;  // why figures are missing; empty: none is
};

}  // namespace spherule::measure
