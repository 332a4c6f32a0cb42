#include "scene/lammps_data.h"
#include "scene/lammps_dump.h"
#include "scene/source.h"
#include "scene/sphere_rows.h"
#include "scene/table_reader.h"

namespace spherule::scene {

std::vector<Sphere> fromLammps(Check& check, const v1::Lammps& lammps, const std::filesystem::path& directory,
                               SourceInput input, FileLines& lines) {
    const double scale = readFileScale(check, lammps.scale(), input);
    TableReader reader(check, at(input.field, "file"), directory / lammps.file());
    if (!reader.nextLine()) {
        reader.refuse(1, "the file is empty, must be a LAMMPS data or dump file");
        return {};
    }
    if (reader.text().starts_with("ITEM:"))
        return fromLammpsDump(check, reader, {.scale = scale, .frame = lammps.frame()}, input, lines);
    if (lammps.frame() > 0) {
        check.refuse(at(input.field, "frame"), "is of no use: a LAMMPS data file has one state; leave frame out");
        return {};
    }
    return fromLammpsData(check, reader, scale, input, lines);
}

}  // namespace spherule::scene
