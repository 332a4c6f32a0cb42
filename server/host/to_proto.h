#pragma once

#include <cstdint>
#include <string>

#include "compute/device.h"
#include "core/result.h"
#include "sim/commands.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

// Converts values of the simulation to messages for clients.
namespace spherule::host {

v1::ServerMessage factsMessage(const sim::Simulation& simulation, std::uint32_t epoch);
// Names the program and its device. Has no scenes.
v1::Welcome welcomeOf(const compute::DeviceInfo& device);
v1::ServerMessage settingsMessage(const scene::Scene& scene, double speed, bool paused);
v1::Statistics statisticsMessage(const sim::Statistics& statistics);

// The answer to a command. The field of a refusal is a path that begins at the Command. The error's `where` begins at
// the command's own message; if it names no field there, it becomes part of the reason.
v1::CommandResult resultOf(const v1::Command& command, const Result<sim::Applied>& applied);

// The command in words, for Change.what: "load box-50k", "reset", "spawn".
std::string wordsFor(const v1::Command& command);

}  // namespace spherule::host
