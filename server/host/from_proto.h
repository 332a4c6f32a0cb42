#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/progress.h"
#include "core/result.h"
#include "scene/load.h"
#include "scene/scene.h"
#include "sim/commands.h"
#include "spherule/v1/control.pb.h"

// Converts messages of clients to values for the simulation. A message with a wrong field is Refused. The error's
// `where` begins at the message.
namespace spherule::host {

Result<sim::Set> setOf(const v1::Set& message);  // without the speed
sim::Spawn spawnOf(const v1::Spawn& message);
Result<sim::Remove> removeOf(const v1::Remove& message);
sim::ChangeObstacle changeOf(const v1::AddObstacle& message);
sim::ChangeObstacle changeOf(const v1::MoveObstacle& message);
sim::ChangeObstacle changeOf(const v1::RemoveObstacle& message);
Result<sim::Push> pushOf(const v1::Push& message);
Result<sim::Pull> pullOf(const v1::Pull& message, std::uint64_t session);
// Returns the command for a simulation, of the session; nullopt if it is none for a simulation itself, such as pause.
std::optional<Result<sim::Command>> worldCommandOf(const v1::Command& command, std::uint64_t session);

// Reads and builds a scene. May run on any thread.
using MakeScene = std::function<Result<scene::Scene>(Progress&)>;

// A name must be one of the scenes that come with the program, so that clients cannot read the server's files.
Result<MakeScene> makeSceneOf(const v1::LoadScene& message, const std::string& deviceKind,
                              const scene::Overrides& overrides);

}  // namespace spherule::host
