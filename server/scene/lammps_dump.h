#pragma once

#include <cstdint>
#include <vector>

#include "scene/source.h"
#include "scene/table_reader.h"

namespace spherule::scene {

struct DumpOptions {
    double scale = 1;         // m per unit of length of the file
    std::uint32_t frame = 0;  // number of the snapshot
};

// Reads the spheres of a snapshot of a LAMMPS dump file, in the order of their atom IDs. `reader` is at the first line.
std::vector<Sphere> fromLammpsDump(Check& check, TableReader& reader, const DumpOptions& options, SourceInput& input,
                                   FileLines& lines);

}  // namespace spherule::scene
