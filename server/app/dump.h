#pragma once

#include <fstream>
#include <string>

#include "core/result.h"
#include "sim/simulation.h"

namespace spherule::app {

// States as text: time,id,x,y,z,vx,vy,vz,radius in SI units, world coordinates.
class Dump {
  public:
    static Result<Dump> create(const std::string& path);
    Result<void> write(sim::Simulation& simulation);

  private:
    explicit Dump(std::string path) : path_(std::move(path)), file_(path_) {}

    std::string path_;
    std::ofstream file_;
};

}  // namespace spherule::app
