#pragma once

#include <string>

#include "core/result.h"
#include "recording/output_file.h"
#include "sim/simulation.h"

namespace spherule::cli {

// Writes states as CSV in SI units and world coordinates. docs/cli.md describes the columns. After write() the state is
// in the file. Without a state there is no file.
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
