#pragma once

#include <memory>
#include <string>

#include "core/result.h"
#include "recording/recording.h"

namespace spherule::recording {

// Writes snapshots of a recording in a format that other tools read. Nothing is there under the names of its files
// before finish(), and nothing is left of one that is destroyed before. Used by one thread. What goes wrong is as
// OutputFile says.
class Exporter {
  public:
    virtual ~Exporter() = default;
    // In the order of time.
    virtual Result<void> add(const Snapshot& snapshot) = 0;
    virtual Result<void> finish() = 0;
    // What somebody who wants to open it must open.
    [[nodiscard]] virtual std::string path() const = 0;
};

using MadeExporter = Result<std::unique_ptr<Exporter>>;

// Extended XYZ, all snapshots in one file: what OVITO and ASE read. `path` "-" is standard output.
MadeExporter xyzExporter(const std::string& path, bool replace);
// CSV, all snapshots in one file: time,id,x,y,z,radius in SI units. `path` "-" is standard output.
MadeExporter csvExporter(const std::string& path, bool replace);
// VTK: `path` (.pvd is added where it is missing) lists the files of the snapshots, PolyData (.vtp) in a folder beside
// it.
MadeExporter vtkExporter(const std::string& path, bool replace);

}  // namespace spherule::recording
