#pragma once

#include <optional>

#include "app/world.h"
#include "core/result.h"
#include "sim/commands.h"
#include "spherule/v1/control.pb.h"

// The only place that maps each command of a simulating server to the code that carries it out.
namespace spherule::app {

// Carries out the commands that World does not: recordings and cancel.
class HostCommands {
  public:
    HostCommands() = default;
    virtual ~HostCommands() = default;
    HostCommands(const HostCommands&) = delete;
    HostCommands& operator=(const HostCommands&) = delete;

    virtual Result<void> startRecording() = 0;
    virtual Result<void> stopRecording() = 0;
    virtual Result<void> cancel() = 0;
};

// Carries out a command, or refuses it and changes nothing. Returns nullopt when a change of the world has begun;
// World::advanceChange() gives the result. While a change is under way, only commands that do not wait for changes (see
// control.proto) may come. A new change replaces the present one.
std::optional<Result<sim::Applied>> dispatch(const v1::Command& command, World& world, HostCommands& host);

}  // namespace spherule::app
