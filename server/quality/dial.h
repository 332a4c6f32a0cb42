#pragma once

#include "quality/table.h"
#include "spherule/v1/control.pb.h"

namespace spherule::quality {

// The table's rungs for this scene: with the substeps that they are here, and the times that they would take where the
// table was measured.
v1::Dial dialFor(const Table& table, const scene::Scene& scene);

// Wall ms of a step, by the position of the model that is nearest; 0 where it has none.
double estimateMs(const v1::Dial& dial, scene::Model model, std::uint32_t substeps);

// With all times multiplied.
v1::Dial calibrated(v1::Dial dial, double ratio);

}  // namespace spherule::quality
