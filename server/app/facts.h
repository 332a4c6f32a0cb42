#pragma once

#include <cstdint>

#include "compute/device.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

namespace spherule::app {

v1::ServerMessage factsMessage(const sim::Simulation& simulation, std::uint32_t epoch);
// The program and its device; without the scenes.
v1::Welcome welcomeOf(const compute::DeviceInfo& device);
v1::ServerMessage settingsMessage(const scene::Scene& scene, double speed, bool paused);

}  // namespace spherule::app
