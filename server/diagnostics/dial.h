#pragma once

#include "diagnostics/table.h"
#include "spherule/v1/control.pb.h"

namespace spherule::diagnostics {

// Returns the table's rungs for this scene: with their substeps for the scene, and their step times on the machine
// where the table was measured.
v1::Dial dialFor(const Table& table, const scene::Scene& scene);

// Returns the wall time of a step (ms), estimated from the nearest position of the model; 0 if the model has none.
double estimateMs(const v1::Dial& dial, scene::Model model, std::uint32_t substeps);

// Returns the dial with all times multiplied by `ratio`, marked as calibrated.
v1::Dial calibrated(v1::Dial dial, double ratio);

}  // namespace spherule::diagnostics
