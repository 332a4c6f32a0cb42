#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "compute/device.h"
#include "core/result.h"
#include "sim/commands.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

// Converts values of the simulation to messages for clients.
namespace spherule::host {

// Names the program and its device. Has no scenes.
v1::Welcome welcomeOf(const compute::DeviceInfo& device);
v1::ServerMessage settingsMessage(const scene::Scene& scene, double speed, bool paused);
v1::Statistics statisticsMessage(const sim::Statistics& statistics);

// Sets the poses of the obstacles that may move. `time`: s simulated.
void setPoses(v1::Frame& frame, const std::vector<scene::Obstacle>& obstacles, double time);

// The answer to a command. The field of a refusal is a path that begins at the Command. The error's `where` begins at
// the command's own message; if it names no field there, it becomes part of the reason.
v1::CommandResult resultOf(const v1::Command& command, const Result<sim::Applied>& applied);

// Tells other sessions that a command was carried out. `spheres`: number of those that it added or removed.
v1::Event eventOf(const v1::Command& command, const sim::Applied& applied, std::uint64_t spheres);

// The command in words, for Change.what: "load box-50k", "reset", "spawn".
std::string wordsFor(const v1::Command& command);

}  // namespace spherule::host
