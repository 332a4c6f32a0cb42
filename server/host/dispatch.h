#pragma once

#include <optional>

#include "core/result.h"
#include "host/requests.h"
#include "host/simulation_host.h"
#include "sim/commands.h"
#include "spherule/v1/control.pb.h"

// The only place that maps each command of a simulating server to the code that carries it out.
namespace spherule::host {

// Carries out the commands that SimulationHost does not: recordings, checkpoints and cancel.
class ProducerCommands {
  public:
    ProducerCommands() = default;
    virtual ~ProducerCommands() = default;
    ProducerCommands(const ProducerCommands&) = delete;
    ProducerCommands& operator=(const ProducerCommands&) = delete;

    virtual Result<void> startRecording() = 0;
    virtual Result<void> stopRecording() = 0;
    virtual Result<void> cancel() = 0;
    // Returns nullopt when a checkpoint is being written: the result comes when it is on the disk.
    virtual std::optional<Result<sim::Applied>> saveCheckpoint() = 0;
};

// Carries out a command, or refuses it and changes nothing. Returns nullopt when a change of the world has begun;
// SimulationHost::advanceChange() gives the result. While a change is under way, only commands that do not wait for
// changes (see control.proto) may come. A new change replaces the present one.
std::optional<Result<sim::Applied>> dispatch(const Request& request, SimulationHost& host, ProducerCommands& producer);

}  // namespace spherule::host
