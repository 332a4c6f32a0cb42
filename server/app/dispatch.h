#pragma once

#include <optional>

#include "app/world.h"
#include "core/result.h"
#include "sim/commands.h"
#include "spherule/v1/control.pb.h"

// The one place where each command of a server that simulates meets the code that carries it out.
namespace spherule::app {

// Carries out the commands that change what the server does beside its world.
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

// Carries out a command, or refuses it and changes nothing. nullopt: a change of the world has begun, and
// World::advanceChange() gives the result. A command may come while a change is under way only if it does not wait for
// changes by its rules in control.proto; a new change replaces the present one.
std::optional<Result<sim::Applied>> dispatch(const v1::Command& command, World& world, HostCommands& host);

}  // namespace spherule::app
