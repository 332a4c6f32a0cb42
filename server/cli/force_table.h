#pragma once

#include <string>

#include "core/result.h"
#include "recording/output_file.h"
#include "sim/simulation.h"

namespace spherule::cli {

// Writes the forces on walls and obstacles as text: time,surface,fx,fy,fz,tx,ty,tz in N and N m, one row for each
// surface. They are means over the time since the last call of write(). Torques are about the centre of the bounds.
class ForceTable {
  public:
    // See OutputFile::create().
    static Result<ForceTable> create(const std::string& path, bool replace);
    // Writes nothing if no time has passed.
    Result<void> write(sim::Simulation& simulation);
    Result<void> finish() { return file_.close(); }

  private:
    explicit ForceTable(recording::OutputFile file) : file_(std::move(file)) {}

    recording::OutputFile file_;
    sim::ContactSums before_;
};

}  // namespace spherule::cli
