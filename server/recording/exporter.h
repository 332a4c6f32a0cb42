#pragma once

#include <memory>
#include <string>

#include "core/result.h"
#include "recording/recording.h"

namespace spherule::recording {

// Writes snapshots of a recording in a format of other tools. The files appear under their names with finish(). An
// exporter that is destroyed before leaves no files. Used by one thread. Errors: see OutputFile.
class Exporter {
  public:
    virtual ~Exporter() = default;
    // Snapshots must come in the order of time.
    virtual Result<void> add(const Snapshot& snapshot) = 0;
    virtual Result<void> finish() = 0;
    // Returns the file to open in another tool.
    [[nodiscard]] virtual std::string path() const = 0;
};

using MadeExporter = Result<std::unique_ptr<Exporter>>;

// The first three have id, position and radius of each sphere, and the columns of SphereTable::exportedColumns().
//
// Extended XYZ for OVITO and ASE, with the periodic axes in `pbc`, all snapshots in one file. `path` "-": standard
// output.
MadeExporter xyzExporter(const std::string& path, bool replace);
// CSV in SI units, all snapshots in one file. `path` "-": standard output.
MadeExporter csvExporter(const std::string& path, bool replace);
// VTK. `path` (.pvd is appended if it is missing) lists the files of the snapshots, PolyData (.vtp) in a folder next to
// it. With periodic axes, the field data `Periods` has their lengths (m), 0 for the others. Obstacles are triangles in
// files of their own: one file for those at rest, and one per snapshot for the others.
MadeExporter vtkExporter(const std::string& path, bool replace);
// CSV of the poses of the obstacles that move, all snapshots in one file. `path` "-": standard output.
MadeExporter posesExporter(const std::string& path, bool replace);

}  // namespace spherule::recording
