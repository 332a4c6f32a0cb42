#pragma once

#include <string>

#include "core/result.h"
#include "recording/output_file.h"
#include "sim/simulation.h"

namespace spherule::cli {

// Writes states as text: time,id,x,y,z,vx,vy,vz,radius,wx,wy,wz,material,group,asleep,contacts in SI units and world
// coordinates. Materials and groups are numbers in the order of the scene, from 0. Spin is 0 in scenes without
// friction. `contacts`: see Simulation::contactCounts(). After write() the state
// is in the file. Without a state there is no file.
class StateDump {
  public:
    // See OutputFile::create().
    static Result<StateDump> create(const std::string& path, bool replace);
    Result<void> write(sim::Simulation& simulation);
    Result<void> finish() { return file_.close(); }

  private:
    explicit StateDump(recording::OutputFile file) : file_(std::move(file)) {}

    recording::OutputFile file_;
};

}  // namespace spherule::cli
