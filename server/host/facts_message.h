#pragma once

#include <cstddef>
#include <cstdint>

#include "encode/places.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

// The facts about the scene and its spheres, as messages for clients.
namespace spherule::host {

v1::ServerMessage factsMessage(const sim::Simulation& simulation, std::uint32_t epoch);
// Returns the facts for clients that follow Population messages. `places`: of the present spheres. `population`: number
// of the last Population message of the epoch.
v1::ServerMessage factsMessage(const sim::Simulation& simulation, std::uint32_t epoch, const encode::Places& places,
                               std::uint32_t population);
v1::ServerMessage partsMessage(const scene::Scene& scene);
// Returns the message about a change. `groupsBefore`: groups of which clients know.
v1::ServerMessage populationMessage(const sim::Simulation& simulation, const encode::Places::Change& change,
                                    std::size_t groupsBefore);

}  // namespace spherule::host
