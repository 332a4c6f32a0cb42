#pragma once

#include <vector>

#include "scene/source.h"
#include "scene/table_reader.h"

namespace spherule::scene {

// Reads the spheres of a LAMMPS data file, in the order of their atom IDs. `reader` is at the first line, which is a
// title. Sections except Atoms and Velocities are skipped. `scale`: m per unit of length of the file.
std::vector<Sphere> fromLammpsData(Check& check, TableReader& reader, double scale, SourceInput& input,
                                   FileLines& lines);

}  // namespace spherule::scene
